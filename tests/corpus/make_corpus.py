#!/usr/bin/env python3
"""Writes the seed corpus of the readers' fuzzers: tests/corpus/<format>/, tiny files, valid and malformed.

Files whose name begins with bad_ must be refused, all others must be read. Run it in any folder; the bytes are fixed.
"""
import base64
import json
import pathlib
import struct
import zlib

HERE = pathlib.Path(__file__).resolve().parent
V = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
F = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]
FLAT = [c for v in V for c in v]


def save(path, data):
    file = HERE / path
    file.parent.mkdir(exist_ok=True)
    file.write_bytes(data.encode("utf-8") if isinstance(data, str) else data)


# PLY ----------------------------------------------------------------------------------------------------------------
def ply_header(form, vertices=4, faces=4, xyz="float", lists="list uchar int vertex_indices", nl="\n", more=()):
    lines = ["ply", f"format {form} 1.0", "comment made by make_corpus.py", f"element vertex {vertices}"]
    lines += [f"property {xyz} {a}" for a in "xyz"]
    lines += [*more, f"element face {faces}", f"property {lists}", "end_header", ""]
    return nl.join(lines)


def ply_body(order, xyz="f", count="B", index="i"):
    body = b"".join(struct.pack(order + 3 * xyz, *v) for v in V)
    return body + b"".join(struct.pack(order + count, 3) + struct.pack(order + 3 * index, *f) for f in F)


ASCII_V = "".join("%g %g %g\n" % v for v in V)
ASCII_F = "".join("3 %d %d %d\n" % f for f in F)
LE, BE = "binary_little_endian", "binary_big_endian"
save("ply/ascii.ply", ply_header("ascii") + ASCII_V + ASCII_F)
save("ply/ascii_crlf.ply", (ply_header("ascii") + ASCII_V + ASCII_F).replace("\n", "\r\n"))
save("ply/ascii_quads.ply", ply_header("ascii", 4, 2, lists="list uint8 uint8 vertex_index")
     + ASCII_V + "4 0 1 2 3\n2 0 1\n")
save("ply/le.ply", ply_header(LE).encode() + ply_body("<"))
save("ply/be.ply", ply_header(BE).encode() + ply_body(">"))
save("ply/be_double_short.ply", ply_header(BE, xyz="double", lists="list ushort ushort vertex_indices").encode()
     + ply_body(">", "d", "H", "H"))
save("ply/le_bytes.ply", ply_header(LE, xyz="char", lists="list int uint vertex_indices").encode()
     + ply_body("<", "b", "i", "I"))
save("ply/le_crlf.ply", ply_header(LE, nl="\r\n").encode() + ply_body("<"))
extra = "element edge 2\nproperty int a\nproperty list uchar float b\n"
save("ply/le_extra.ply", ply_header(LE).replace("element vertex", extra + "element vertex").encode()
     + struct.pack("<iB2fiB", 7, 2, .5, .5, 9, 0) + ply_body("<"))
save("ply/le_coloured.ply", ply_header(LE, more=[f"property uchar {c}" for c in ("red", "green", "blue")]).encode()
     + b"".join(struct.pack("<3f3B", *v, 1, 2, 3) for v in V) + b"".join(struct.pack("<B3i", 3, *f) for f in F))
strip = ply_header(LE, 4, 1, lists="list int int vertex_indices").replace("element face", "element tristrips")
save("ply/strips.ply", strip.encode() + ply_body("<")[:48] + struct.pack("<10i", 9, 0, 1, 2, 3, -1, 0, 2, 1, 3))
save("ply/bad_index.ply", ply_header("ascii") + ASCII_V + ASCII_F.replace("2 3", "2 9", 1))
save("ply/nan_vertex.ply", ply_header("ascii") + ASCII_V.replace("1 0 0", "nan 0 0") + ASCII_F)
save("ply/inf_vertex.ply", ply_header(LE).encode() + struct.pack("<f", float("inf")) + ply_body("<")[4:])
save("ply/bad_truncated.ply", ply_header(LE).encode() + ply_body("<")[:-5])
save("ply/bad_huge.ply", ply_header(LE, 10**18, 10**18).encode() + ply_body("<"))
save("ply/bad_huge_list.ply", ply_header(LE, 4, 1, lists="list uint int vertex_indices").encode()
     + ply_body("<")[:48] + struct.pack("<Ii", 0xffffffff, 0))
save("ply/bad_points.ply", ply_header("ascii", faces=0) + ASCII_V)
save("ply/bad_header.ply", "ply\nformat ascii 1.0\nelement vertex\n")
save("ply/bad_type.ply", ply_header("ascii", xyz="complex") + ASCII_V + ASCII_F)

# OBJ ----------------------------------------------------------------------------------------------------------------
OBJ_V = "".join("v %g %g %g\n" % v for v in V)
OBJ_F = "".join("f %d %d %d\n" % tuple(i + 1 for i in f) for f in F)
save("obj/plain.obj", "# a tetrahedron\n" + OBJ_V + OBJ_F)
save("obj/forms.obj", "mtllib a.mtl\no thing\n" + OBJ_V + "vt 0 0\nvn 0 0 1\ng a b\ns off\nusemtl m\n"
     "f 1/1 3/1 2/1\nf 1//1 2//1 4//1\nf 2/1/1 3/1/1 4/1/1\nf -2 -4 -1\nl 1 2\np 1\n")
save("obj/colours.obj", "".join("v %g %g %g 0.1 0.2 0.3\n" % v for v in V) + OBJ_F.replace("\n", "\r\n"))
save("obj/continued.obj", "v 0 \\\n 0 0\nv 1 0 0\nv 0 1 0\nv +1e0 .5 -2.E-1\nf 1 2 \\\r\n 3 \\\n 4")
save("obj/mac.obj", (OBJ_V + OBJ_F).replace("\n", "\r"))
save("obj/bad_index.obj", OBJ_V + "f 1 2 99\n")
save("obj/bad_zero.obj", OBJ_V + "f 0 1 2\n")
save("obj/bad_negative.obj", OBJ_V + "f -1 -2 -9\n")
save("obj/bad_number.obj", "v 0 0 0\nv 1,5 0 0\nv 0 1 0\nf 1 2 3\n")
save("obj/bad_overflow.obj", "v 0 0 0\nv 1e999 0 0\nv 0 1 0\nf 1 2 3\n")
save("obj/bad_short.obj", "v 0 0\nv 1 0 0\nf 1 1 2\n")
save("obj/bad_points.obj", OBJ_V)

# STL ----------------------------------------------------------------------------------------------------------------


def stl_ascii(name="tetra"):
    text = f"solid {name}\n"
    for f in F:
        text += " facet normal 0 0 0\n  outer loop\n"
        text += "".join("   vertex %g %g %g\n" % V[i] for i in f) + "  endloop\n endfacet\n"
    return text + f"endsolid {name}\n"


def stl_binary(header=b"", faces=F, count=None):
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *(c for i in f for c in V[i]), 0) for f in faces)
    return header.ljust(80, b"\0") + struct.pack("<I", len(faces) if count is None else count) + body


save("stl/ascii.stl", stl_ascii())
save("stl/ascii_upper.stl", stl_ascii("vertex facet").upper().replace("\n", "\r\n"))
save("stl/ascii_two.stl", stl_ascii("a") + stl_ascii("b"))
save("stl/binary.stl", stl_binary())
save("stl/binary_solid.stl", stl_binary(b"solid facet normal"))
save("stl/binary_trailing.stl", stl_binary(b"trailing bytes") + b"abc")
save("stl/bad_truncated.stl", stl_binary()[:-20])
save("stl/bad_huge.stl", stl_binary(count=0xffffffff))
save("stl/bad_empty.stl", stl_binary(faces=[]))
save("stl/bad_nan.stl", stl_binary().replace(struct.pack("<f", 1), struct.pack("<f", float("nan"))))
save("stl/bad_ascii_cut.stl", stl_ascii()[:200])
save("stl/bad_ascii_two_corners.stl", stl_ascii().replace("   vertex 0 0 0\n", "", 1))

# OFF ----------------------------------------------------------------------------------------------------------------
save("off/plain.off", "OFF\n4 4 6\n" + ASCII_V + ASCII_F)
save("off/same_line.off", "# first\nOFF 4 4 0 # counts\n\n" + ASCII_V.replace("\n", " # c\n") + ASCII_F)
save("off/coff.off", "COFF\n4 4\n" + ASCII_V.replace("\n", " 255 0 0 255\n") + ASCII_F.replace("\n", " 0.1 0.2 0.3\n"))
save("off/noff.off", "NOFF\r\n4 1 0\r\n" + ASCII_V.replace("\n", " 0 0 1\r\n") + "4 0 1 2 3 7\r\n")
save("off/no_word.off", "4 4 6\n" + ASCII_V + ASCII_F)
save("off/bad_index.off", "OFF\n4 4 6\n" + ASCII_V + ASCII_F.replace("2 3", "2 4", 1))
save("off/bad_huge.off", "OFF\n999999999999 1 0\n" + ASCII_V + ASCII_F)
save("off/bad_truncated.off", "OFF\n4 4 6\n" + ASCII_V + ASCII_F[:-8])
save("off/bad_4off.off", "4OFF\n4 4 6\n" + ASCII_V.replace("\n", " 1\n") + ASCII_F)
save("off/bad_binary.off", b"OFF BINARY\n" + struct.pack(">3i", 4, 4, 6))
save("off/bad_polygon.off", "OFF\n4 1 6\n" + ASCII_V + "4000000000 0 1 2\n")

# GLB, glTF ----------------------------------------------------------------------------------------------------------


def glb(document, binary=b"", version=2, length=None):
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    if binary:
        chunks += struct.pack("<I4s", len(binary), b"BIN\0") + binary
    return struct.pack("<4sII", b"glTF", version, 12 + len(chunks) if length is None else length) + chunks


POINTS = struct.pack("<12f", *FLAT)


def scene(mode=4, index=None, values=None, nodes=None, stride=None):
    """One mesh over POINTS; `index` is a component type of 5121, 5123, 5125."""
    values = [i for f in F for i in f] if values is None else values
    pack = {5121: "B", 5123: "H", 5125: "I"}
    tail = b"" if index is None else struct.pack(f"<{len(values)}{pack[index]}", *values)
    points = POINTS if stride is None else b"".join(struct.pack("<3f", *v).ljust(stride, b"\0") for v in V)
    primitive = {"attributes": {"POSITION": 0}, "mode": mode}
    views = [{"buffer": 0, "byteLength": len(points)}]
    if stride:
        views[0]["byteStride"] = stride
    accessors = [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]}]
    if index is not None:
        primitive["indices"] = 1
        views.append({"buffer": 0, "byteOffset": len(points), "byteLength": len(tail)})
        accessors.append({"bufferView": 1, "componentType": index, "count": len(values), "type": "SCALAR"})
    document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": nodes or [{"mesh": 0}],
                "meshes": [{"primitives": [primitive]}], "accessors": accessors, "bufferViews": views,
                "buffers": [{"byteLength": len(points + tail)}]}
    return document, points + tail


save("glb/u8.glb", glb(*scene(index=5121)))
save("glb/u16_stride.glb", glb(*scene(index=5123, stride=16)))
save("glb/u32.glb", glb(*scene(index=5125)))
save("glb/strip.glb", glb(*scene(mode=5)))
save("glb/fan.glb", glb(*scene(mode=6, index=5123, values=[0, 1, 2, 3])))
TREE = [{"children": [1, 2], "translation": [1, 2, 3], "rotation": [0, 0, .70710678, .70710678]},
        {"mesh": 0, "scale": [-2, 2, 2]}, {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1]}]
save("glb/tree.glb", glb(*scene(index=5121, nodes=TREE)))
doc, data = scene(index=5125)
doc["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
save("glb/embedded.gltf", json.dumps(doc, indent=1))
doc["buffers"][0]["uri"] = "tetra.bin"
save("glb/bad_external.gltf", json.dumps(doc))
doc, data = scene(index=5125)
doc["extensionsRequired"] = ["KHR_draco_mesh_compression"]
save("glb/bad_draco.glb", glb(doc, data))
save("glb/bad_index.glb", glb(*scene(index=5121, values=[0, 1, 200])))
save("glb/bad_length.glb", glb(*scene(index=5121), length=10**9))
save("glb/bad_version.glb", glb(*scene(index=5121), version=1))
save("glb/bad_cycle.glb", glb(*scene(index=5121, nodes=[{"mesh": 0, "children": [0]}])))
doc, data = scene(index=5121)
doc["accessors"][0]["count"] = 2**53
save("glb/bad_huge.glb", glb(doc, data))
doc, data = scene(index=5121)
doc["accessors"][1]["bufferView"] = -1
save("glb/bad_view.glb", glb(doc, data))
save("glb/bad_points.glb", glb(*scene(mode=0)))
save("glb/bad_json.glb", glb({"asset": 0}).replace(b"asset", b'as"et'))
doc, data = scene(index=5121, nodes=[{"children": [i + 1, i + 1]} for i in range(40)] + [{"mesh": 0}])
save("glb/bad_bomb.glb", glb(doc, data))

# 3MF ----------------------------------------------------------------------------------------------------------------
CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
MESH = ("<mesh><vertices>" + "".join('<vertex x="%g" y="%g" z="%g"/>' % v for v in V) + "</vertices><triangles>"
        + "".join('<triangle v1="%d" v2="%d" v3="%d"/>' % f for f in F) + "</triangles></mesh>")
RELS = ('<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
        '<Relationship Id="r" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel" Target="/%s"/>'
        "</Relationships>")


def model(resources, build):
    return (f'<?xml version="1.0" encoding="UTF-8"?>\n<!-- <mesh> --><model unit="inch" xmlns="{CORE}">'
            f"<resources>{resources}</resources><build>{build}</build></model>")


def zip_file(entries, stored=False, size=None, zip64=False):
    data, directory = b"", b""
    for name, text in entries:
        raw = text.encode()
        deflate = zlib.compressobj(9, zlib.DEFLATED, -15)
        packed = raw if stored else deflate.compress(raw) + deflate.flush()
        real = len(raw) if size is None else size
        sizes = (0xffffffff, 0xffffffff) if zip64 else (len(packed), real)
        more = struct.pack("<HHQQ", 1, 16, real, len(packed)) if zip64 else b""
        common = struct.pack("<HHHHHIIIHH", 20, 0, 0 if stored else 8, 0, 0x21, zlib.crc32(raw), *sizes, len(name), len(more))
        directory += (b"PK\1\2" + struct.pack("<H", 20) + common + struct.pack("<HHHII", 0, 0, 0, 0, len(data))
                      + name.encode() + more)
        data += b"PK\3\4" + common + name.encode() + more + packed
    end = struct.pack("<4s4H2IH", b"PK\5\6", 0, 0, len(entries), len(entries), len(directory), len(data), 0)
    return data + directory + end


def package(resources, build, name="3D/3dmodel.model", more=(), **options):
    return zip_file([("_rels/.rels", RELS % name), (name, model(resources, build)), *more], **options)


# A model outside of its package: no mesh file, but a seed for the fuzzer, which wraps it.
SEED = ('<object id="2" type="model"><components><component p:path="/3D/3dmodel.model" objectid="1"/>'
        "<component objectid='1' transform='1 0 0 0 1 0 0 0 1 5 0 0'/></components></object>")
save("3mf/bad_plain_model.xml", model(f'<object id="1" type="model">{MESH}</object>' + SEED,
                                      '<item objectid="2" transform="-1 0 0 0 2 0 0 0 1 0 0 0"/>'))
ONE = f'<object id="1" type="model">{MESH}</object>'
ITEM = '<item objectid="1"/>'
save("3mf/deflated.3mf", package(ONE, ITEM))
save("3mf/stored.3mf", package(ONE, ITEM, stored=True))
save("3mf/zip64.3mf", package(ONE, ITEM, zip64=True))
save("3mf/other_name.3mf", package(ONE, ITEM, name="x/y.model"))
save("3mf/components.3mf", package(
    ONE + '<object id="2"><components><component objectid="1"/>'
    '<component objectid="1" transform="1 0 0 0 1 0 0 0 1 5 0 0"/></components></object>',
    '<item objectid="2" transform="-1 0 0 0 2 0 0 0 1 0 0 0"/>'))
save("3mf/production.3mf", package(
    '<object id="2"><components><component p:path="/3D/Objects/a.model" objectid="1"/></components></object>',
    '<item objectid="2"/>', more=[("3D/Objects/a.model", model(ONE, ""))]))
save("3mf/prefixed.3mf", package(ONE.replace("<vert", "<c:vert").replace("</vert", "</c:vert").replace('"', "'"), ITEM))
save("3mf/bad_index.3mf", package(ONE.replace('v3="3"', 'v3="4"'), ITEM))
save("3mf/nan_vertex.3mf", package(ONE.replace('x="1"', 'x="nan"'), ITEM))
save("3mf/support.3mf", package(ONE + f'<object id="2" type="support">{MESH}</object>', ITEM + ITEM.replace("1", "2")))
save("3mf/bad_support.3mf", package(ONE.replace('"model"', '"support"'), ITEM))
save("3mf/bad_unit.3mf", zip_file([("_rels/.rels", RELS % "m.model"),
                                   ("m.model", model(ONE, ITEM).replace('"inch"', '"inches"'))]))
save("3mf/bad_object.3mf", package(ONE, '<item objectid="7"/>'))
save("3mf/bad_cycle.3mf", package('<object id="1"><components><component objectid="1"/></components></object>', ITEM))
BOMB = ONE + "".join(f'<object id="{i + 1}"><components><component objectid="{i}"/><component objectid="{i}"/></components>'
                     "</object>" for i in range(1, 40))
save("3mf/bad_bomb.3mf", package(BOMB, '<item objectid="40"/>'))
save("3mf/bad_size.3mf", package(ONE, ITEM, size=2**31))
save("3mf/bad_empty.3mf", package("", ""))
save("3mf/bad_xml.3mf", package("<object id=1", ITEM))
save("3mf/bad_other_zip.3mf", zip_file([("word/document.xml", "<a/>")]))
save("3mf/bad_truncated.3mf", package(ONE, ITEM)[:-30])
save("3mf/bad_crc.3mf", package(ONE, ITEM, stored=True).replace(b'v1="0"', b'v1="1"'))

# Points -------------------------------------------------------------------------------------------------------------
# The tetrahedron's corners; all files that are not bad_ hold them, with N as normals where their name has "normals".
N = [(-.6, -.8, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
ROWS = ["%g %g %g" % v for v in V]
NORMALS = ["%g %g %g" % n for n in N]
COLOURS = ["255 0 0", "0 255 0", "0 0 255", "12 34 56"]


def table(*columns, before="", nl="\n"):
    return before + "".join(" ".join(row) + nl for row in zip(*columns))


def point_ply(form, names, rows, kind="float", more=""):
    head = ["ply", f"format {form} 1.0", f"element vertex {len(rows)}", *(f"property {kind} {n}" for n in names)]
    return "\n".join(head) + "\n" + more + "end_header\n"


BOTH = [v + n for v, n in zip(V, N)]
XYZN = ["x", "y", "z", "nx", "ny", "nz"]
save("points/plain.xyz", table(ROWS))
save("points/comments.xyz", "# four points\n// x y z\n\n" + table(ROWS, nl="   # a corner\r\n") + "\n\n#end")
save("points/commas.xyz", table(ROWS).replace(" ", ", "))
save("points/semicolons_normals.xyz", table(ROWS, NORMALS).replace(" ", ";").replace("\n", ";\n"))
save("points/mac.xyz", table(ROWS, nl="\r"))
save("points/no_last_end.xyz", table(ROWS)[:-1])
save("points/tabs_normals.xyz", table(ROWS, NORMALS).replace(" ", "\t"))
save("points/colours.xyz", table(ROWS, COLOURS))
save("points/intensity.xyz", table(ROWS, ["0.5", "1", "2", "-3e2"]))
save("points/colours_then_normals.xyz", table(ROWS, COLOURS, NORMALS))
save("points/normals_then_colours.xyz", table(ROWS, NORMALS, COLOURS))
save("points/nan_normals.xyz", table(ROWS, ["nan nan nan", *NORMALS[1:]]))
save("points/count.pts", table(ROWS, before="4\n"))
save("points/no_count.pts", table(ROWS))
save("points/intensity.pts", table(ROWS, ["-1200", "0", "17", "2047"], before="4\r\n", nl="\r\n"))
save("points/intensity_colours.pts", table(ROWS, ["1", "2", "3", "4"], COLOURS, before="4\n"))
save("points/blocks_normals.pwn", table(ROWS, before="4\n") + table(NORMALS))
save("points/columns_normals.pwn", table(ROWS, NORMALS, before="4\n"))
save("points/ascii.ply", point_ply("ascii", "xyz", V) + table(ROWS))
save("points/ascii_normals.ply", point_ply("ascii", XYZN, V) + table(ROWS, NORMALS))
save("points/no_faces_normals.ply", point_ply("ascii", XYZN, V, more="element face 0\nproperty list uchar int "
                                              "vertex_indices\n") + table(ROWS, NORMALS))
save("points/le_normals.ply", point_ply(LE, XYZN, V).encode() + b"".join(struct.pack("<6f", *r) for r in BOTH))
save("points/be_normals.ply", point_ply(BE, XYZN, V, "double").encode()
     + b"".join(struct.pack(">6d", *r) for r in BOTH))
save("points/le_mixed_normals.ply", point_ply(LE, [*XYZN[3:], "scale", *XYZN[:3]], V).encode()
     + b"".join(struct.pack("<7f", *n, 9, *v) for v, n in zip(V, N)))
save("points/le_list_normals.ply", point_ply(LE, XYZN, V, more="property list uchar short tags\n").encode()
     + b"".join(struct.pack("<6fBh", *r, 1, 7) for r in BOTH))
save("points/le_half_normal.ply", point_ply(LE, XYZN[:5], V).encode()
     + b"".join(struct.pack("<5f", *r[:5]) for r in BOTH))
save("points/nan_normals.ply", point_ply(LE, XYZN, V).encode() + struct.pack("<6f", *V[0], *3 * [float("nan")])
     + b"".join(struct.pack("<6f", *r) for r in BOTH[1:]))
save("points/all_zero.ply", point_ply("ascii", XYZN, V) + table(ROWS, 4 * ["0 0 0"]))
save("points/all_nan.pwn", table(ROWS, 4 * ["nan 0 0"], before="4\n"))
save("points/bad_empty.xyz", "")
save("points/bad_comments.xyz", "# nothing\n\n  // but words\n")
save("points/bad_word.xyz", table(ROWS).replace("0 1 0", "0 one 0"))
save("points/nan_point.xyz", "0 nan 0\n" + table(ROWS))
save("points/inf_point.xyz", table(ROWS) + "0 1e999 0\n")
save("points/bad_two_columns.xyz", "1 2\n3 4\n")
save("points/bad_columns.xyz", table(ROWS).replace("0 1 0", "0 1 0 7"))
save("points/bad_truncated.xyz", table(ROWS, NORMALS)[:-5])
save("points/bad_decimal_commas.xyz", "1,5 2,5 3,5\n4,5 5,5 6,5\n")
save("points/bad_gap.xyz", "1,,2,3\n")
save("points/bad_chemistry.xyz", "3\nwater\nO 0 0 0\nH 1 0 0\nH 0 1 0\n")
save("points/bad_binary.xyz", bytes(range(256)))
save("points/bad_more.pts", table(ROWS, before="3\n"))
save("points/bad_fewer.pts", table(ROWS, before="5\n"))
save("points/bad_huge.pts", table(ROWS, before="99999999999999999999\n"))
save("points/bad_only_count.pts", "4\n")
save("points/bad_truncated.pwn", (table(ROWS, before="4\n") + table(NORMALS))[:-6])
save("points/bad_no_normals.pwn", table(ROWS, before="4\n"))
save("points/nan_point.ply", point_ply("ascii", "xyz", [0, *V]) + "0 nan 0\n" + table(ROWS))
save("points/bad_truncated.ply", point_ply(LE, "xyz", V).encode() + b"\0" * 47)
save("points/bad_huge.ply", point_ply(LE, XYZN, V).replace("vertex 4", f"vertex {10**15}"))
save("points/bad_none.ply", point_ply("ascii", "xyz", []))
save("points/bad_mesh.ply", ply_header("ascii") + ASCII_V + ASCII_F)

save("points/titles.xyz", "X Y Z\n" + table(ROWS))
save("points/titles_normals.csv", '# of a spreadsheet\n"x", "y", "z", "nx", "ny", "nz"\n' + table(ROWS, NORMALS).replace(" ", ","))
save("points/plain.obj", "".join(f"v {r}\n" for r in ROWS))
save("points/normals.obj", "".join(f"vn {n}\nv {r}\n" for n, r in zip(NORMALS, ROWS)))
save("points/plain.off", "OFF\n4 0 0\n" + table(ROWS))
save("points/bad_lines.obj", "".join(f"v {r}\n" for r in ROWS) + "l 1 2\n")


def lzf(data):
    """Packs as liblzf does: runs of up to 32 bytes, copies of 3 to 264 from up to 8192 back."""
    out, run, i = b"", b"", 0
    while i <= len(data):
        ends = [(n, b) for b in range(1, i + 1) for n in range(264, 2, -1)
                if i + n <= len(data) and (data[i - b:i] * n)[:n] == data[i:i + n]] if i < len(data) else []
        if run and (ends or i == len(data) or len(run) == 32):
            out, run = out + bytes([len(run) - 1]) + run, b""
        if i == len(data):
            break
        if not ends:
            run, i = run + data[i:i + 1], i + 1
            continue
        n, b = max(ends)
        out += bytes([(n - 2) << 5 | (b - 1) >> 8] if n < 9 else [7 << 5 | (b - 1) >> 8, n - 9]) + bytes([b - 1 & 255])
        i += n
    return out


def pcd(kind, names, rows, sizes=4, types="F", body=b"", count=1):
    fields = names.split()
    line = lambda key, value: f"{key} " + " ".join([str(value)] * len(fields)) + "\n"
    return ("# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS " + names + "\n" + line("SIZE", sizes)
            + line("TYPE", types) + line("COUNT", count) + f"WIDTH {len(rows)}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\n"
            f"POINTS {len(rows)}\nDATA {kind}\n").encode() + body


PCD = "x y z normal_x normal_y normal_z"
COLUMNS = b"".join(struct.pack("<4f", *c) for c in zip(*BOTH))
PACKED = struct.pack("<2I", len(lzf(COLUMNS)), len(COLUMNS)) + lzf(COLUMNS)
save("points/ascii_normals.pcd", pcd("ascii", PCD, V, body=table(ROWS, NORMALS).encode()))
save("points/colours.pcd", pcd("ascii", "rgb x y z", V, body=table(["7", "8", "nan", "9"], ROWS).encode()))
save("points/binary_normals.pcd", pcd("binary", PCD, V, 8, body=b"".join(struct.pack("<6d", *r) for r in BOTH)))
save("points/whole.pcd", pcd("binary", "x y z", V, 2, "I", b"".join(struct.pack("<3h", *v) for v in V)))
save("points/packed_normals.pcd", pcd("binary_compressed", PCD, V, body=PACKED))
save("points/nan_point.pcd", pcd("ascii", "x y z", [0, *V], body=b"nan nan nan\n" + table(ROWS).encode()))
save("points/bad_packed.pcd", pcd("binary_compressed", PCD, V, body=PACKED[:30] + b"\xff" * (len(PACKED) - 30)))
save("points/bad_truncated.pcd", pcd("binary", PCD, V, body=b"\0" * 95))
save("points/bad_kind.pcd", pcd("text", PCD, V))
save("points/bad_fields.pcd", pcd("ascii", "x y w", V, body=table(ROWS).encode()))
save("points/bad_size.pcd", pcd("binary", "x y z", V, 3, body=b"\0" * 36))

# Scenes -------------------------------------------------------------------------------------------------------------
BALL = {"implicit": "x^2+y^2+z^2-R^2", "parameters": {"R": 1}, "bounds": [-2, -2, -2, 2, 2, 2]}
TURN = {"scale": 0.3, "rotate": {"axis": [0, 0, 1], "degrees": 30}, "translate": [0, 0, 1]}
for scene, tree in {
    "sets": {"name": "sets", "units": "mm", "difference": [{"union": [BALL, {"gallery": "torus"}]},
             {"intersection": [BALL, {"gallery": "sphere"}]}]},
    "moved": {"transform": TURN, "of": {"transform": {"scale": [1, 2, -1]}, "of": {"mesh": "../off/plain.off"}}},
    "matrix": {"transform": {"matrix": [[0, -1, 0, 5], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}, "of": BALL},
    "offsets": {"closing": 0.1, "of": {"opening": 0.1, "of": {"offset": -0.2, "of": BALL}}},
    "points": {"$schema": "../../../docs/scene.schema.json", "points": "../points/plain.xyz"},
    "bad_axis": {"union": [BALL, {"transform": {"rotate": {"axis": [0, 0, 0], "degrees": 1}}, "of": BALL}]},
    "bad_two_keys": {"union": [BALL], "gallery": "sphere"},
    "bad_key": {"unite": [BALL]},
    "bad_file": {"mesh": "none.stl"},
    "bad_points": {"union": [{"points": "../points/plain.xyz"}, BALL]},
    "bad_formula": {"implicit": "x^2+("},
    "bad_singular": {"transform": {"scale": [1, 0, 1]}, "of": BALL},
    "bad_matrix": {"transform": {"matrix": 16 * [1]}, "of": BALL},
    "bad_apart": {"intersection": [BALL, {"transform": {"translate": [9, 0, 0]}, "of": BALL}]},
}.items():
    save(f"scene/{scene}.json", json.dumps(tree, indent=1) + "\n")
save("scene/bad_deep.json", 600 * '{"union":[' + json.dumps(BALL) + 600 * "]}")
save("scene/bad_twice.json", '{"gallery": "sphere", "gallery": "torus"}')
save("scene/bad_comma.json", '{"union": [{"gallery": "sphere"},]}')
save("scene/bad_cut.json", '{"union": [{"gallery": "sph')

ROUND = "$fn = 0, $fa = 12, $fs = 2, "
SHIFT = "multmatrix([[1, 0, 0, 3], [0, 1, 0, 0], [0, 0, 1, 1e-05], [0, 0, 0, 1]])"
save("scene/bodies.csg", f"""// written by hand
cube(size = [1, 2, 3], center = false);
{SHIFT} {{
\tsphere({ROUND}r = 1);
\tcylinder({ROUND}h = 2, r1 = 1, r2 = 0, center = true);
}}
polyhedron(points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], faces = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]]);
""")
save("scene/sets.csg", f"""difference() {{
\tgroup() {{
\t\tcube(size = [4, 4, 4], center = true);
\t}}
\tgroup();
\tcolor([1, 0, 0, 1]) {{
\t\tsphere({ROUND}r = 2.5);
\t}}
\t%cube(size = 9);
\t#intersection() {{
\t\tcube();
\t\trender(convexity = 1) {{ {SHIFT} {{ cube(size = 9, center = true); }} }}
\t}}
}}
""")
save("scene/extrusions.csg", f"""linear_extrude(height = 2, center = true, convexity = 1, twist = 90, slices = 8, scale = [1, 0.5]) {{
\tpolygon(points = [[0, 0], [4, 0], [4, 4], [0, 4], [1, 1], [2, 1], [2, 2]], paths = [[0, 1, 2, 3], [4, 5, 6]]);
}}
rotate_extrude(angle = 270, convexity = 2, {ROUND[:-2]}) {{
\t{SHIFT} {{
\t\tunion() {{ circle({ROUND}r = 1); square(size = [1, 1], center = false); }}
\t}}
}}
linear_extrude(height = 1) {{ polygon(points = [[0, 0], [3, 0], [3, 3], [1, 1], [0, 3]], paths = undef); }}
""")
save("scene/import.csg", 'group() {\n\timport(file = "../off/plain.off", layer = "", origin = [0, 0], timestamp = 0);\n}\n')
save("scene/root.csg", "sphere(); !cube(); /* rest */ cylinder();\n")
save("scene/star.csg", "linear_extrude(height = 1) { polygon(points = [[0, 3], [2, -3], [-3, 1], [3, 1], [-2, -3]]); }\n")
save("scene/bad_minkowski.csg", "minkowski() {\n\tcube();\n}\n")
save("scene/bad_flat.csg", "square(size = 1);\n")
save("scene/bad_nothing.csg", "group();\n")
save("scene/bad_brace.csg", "union() { cube();\n")
save("scene/bad_name.csg", "cuboid();\n")
save("scene/bad_nan.csg", "cube(size = [1, nan, 1]);\n")
save("scene/bad_index.csg", "polyhedron(points = [[0, 0, 0]], faces = [[0, 1, 2]]);\n")
save("scene/bad_huge.csg", "sphere($fn = 999999);\n")
save("scene/bad_axis.csg", "rotate_extrude() { circle(r = 1); }\n")
save("scene/bad_file.csg", 'import(file = "none.stl");\n')
save("scene/bad_flattened.csg", "multmatrix([[1,0,0,0],[0,1,0,0],[0,0,0,0],[0,0,0,1]]) { cube(); }\n")
save("scene/bad_deep.csg", 600 * "group(){" + "cube();" + 600 * "}")
save("scene/bad_lists.csg", "cube(size = " + 100 * "[" + "1" + 100 * "]" + ");")
