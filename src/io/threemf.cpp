/// 3MF (3D Manufacturing Format, core specification 1.3): the build items with their components, placed, in their unit.
/// Materials and slices are passed over, supports left out. Of the production extension, components in other parts of
/// the package are followed.
///
/// The reader is small and its own because lib3mf 1.8 was seen to leak memory on damaged packages.

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "geometry/single_precision.h"
#include "io/affine.h"
#include "io/formats.h"
#include "io/text.h"
#include "io/xml.h"
#include "io/zip.h"

namespace evenmesh {
namespace {

/// What is placed: an object of a part of the package.
struct Reference {
  std::string path;  ///< empty: the same part
  std::uint64_t object = 0;
  PartPlacement placement;
};

struct Object {
  std::string type;  ///< "model" where none is given
  Mesh mesh;
  std::vector<Reference> components;
};

struct Model {
  std::map<std::uint64_t, Object> objects;
  std::vector<Reference> items;
  LengthUnit unit = LengthUnit::millimeter;
};

/// What is printed to hold the model up, and broken off again.
bool is_support(const Object& object) {
  return object.type == "support" || object.type == "solidsupport";
}

// ---- One model part -------------------------------------------------------------------------------------------------

class ModelParser {
 public:
  explicit ModelParser(const Source& source) : source_(source), tags_(source_) {}

  Model parse() {
    while (const auto tag = tags_.next()) {
      if (++tags_seen_ % (1 << 16) == 0) source_.context->throw_if_cancelled();
      if (tag->opens) open(*tag);
      if (tag->closes) close(*tag);
    }
    if (!model_seen_) fail(source_, "holds no <model>; export the file again");
    if (object_) fail(source_, "ends within an object; export the file again");
    return std::move(model_);
  }

 private:
  void open(const XmlTags::Tag& tag) {
    if (tag.name == "model") {
      model_seen_ = true;
      model_.unit = unit_of(tag);
    }
    if (tag.name == "mesh" && object_) in_mesh_ = true;
    if (in_mesh_ && tag.name == "vertex") return read_vertex(tag);
    if (in_mesh_ && tag.name == "triangle") return read_triangle(tag);
    if (tag.name == "object") {
      object_ = &model_.objects[number(tag, "id")];
      object_->type = tag.attribute("type").value_or("model");
    } else if (tag.name == "component" && object_) {
      object_->components.push_back(reference(tag));
    } else if (tag.name == "item") {
      model_.items.push_back(reference(tag));
    }
  }
  void close(const XmlTags::Tag& tag) {
    if (tag.name == "mesh") in_mesh_ = false;
    if (tag.name == "object") {
      object_ = nullptr;
      in_mesh_ = false;
    }
  }

  void read_vertex(const XmlTags::Tag& tag) {
    Vec3 v;
    int seen = 0;
    tag.for_each([&](std::string_view key, std::string_view value) {
      if (key.size() != 1 || key[0] < 'x' || key[0] > 'z') return;
      const char* p = value.data();
      double& coordinate = v[key[0] - 'x'];
      if (!scan_number(p, value.data() + value.size(), coordinate)) {
        fail_at(source_, value.data(), fmt::format("{} is no coordinate", quoted(value)));
      }
      seen |= 1 << (key[0] - 'x');
    });
    if (seen != 7) fail_at(source_, tag.name.data(), "a vertex lacks x, y or z");
    object_->mesh.vertices.push_back(v);
  }

  void read_triangle(const XmlTags::Tag& tag) {
    Triangle t{};
    int seen = 0;
    const std::size_t count = object_->mesh.vertices.size();
    tag.for_each([&](std::string_view key, std::string_view value) {
      if (key.size() != 2 || key[0] != 'v' || key[1] < '1' || key[1] > '3') return;
      const char* p = value.data();
      std::int64_t index = 0;
      if (!scan_integer(p, value.data() + value.size(), index)) {
        fail_at(source_, value.data(), fmt::format("{} is no vertex index", quoted(value)));
      }
      if (index < 0 || static_cast<std::uint64_t>(index) >= count) {
        fail_at(source_, value.data(),
                fmt::format("vertex index {} is out of range (the object has {} vertices)", index, count));
      }
      t[static_cast<std::size_t>(key[1] - '1')] = static_cast<std::uint32_t>(index);
      seen |= 1 << (key[1] - '1');
    });
    if (seen != 7) fail_at(source_, tag.name.data(), "a triangle lacks v1, v2 or v3");
    object_->mesh.triangles.push_back(t);
  }

  LengthUnit unit_of(const XmlTags::Tag& tag) const {
    const std::string_view word = tag.attribute("unit").value_or("millimeter");
    const std::optional<LengthUnit> unit = unit_of_name(word);
    if (!unit || word != word_of(*unit))
      fail_at(source_, word.data(), fmt::format("{} is no unit of a 3MF file; write millimeter there", quoted(word)));
    return *unit;
  }

  std::uint64_t number(const XmlTags::Tag& tag, std::string_view key) const {
    const std::string_view value = tag.attribute(key).value_or("");
    const char* p = value.data();
    std::int64_t found = 0;
    if (!scan_integer(p, value.data() + value.size(), found) || found < 0) {
      fail_at(source_, tag.name.data(), fmt::format("<{}> has no valid '{}'", tag.name, key));
    }
    return static_cast<std::uint64_t>(found);
  }

  Reference reference(const XmlTags::Tag& tag) const {
    Reference reference{std::string(tag.attribute("path").value_or("")), number(tag, "objectid"), {}};
    if (const auto text = tag.attribute("transform")) reference.placement = placement(*text);
    return reference;
  }

  /// Twelve numbers, row after row, for row vectors (core specification §3.3).
  PartPlacement placement(std::string_view text) const {
    PartPlacement affine;
    const char* p = text.data();
    const char* end = p + text.size();
    for (int i = 0; i < 12; ++i) {
      while (p < end && is_xml_space(*p)) ++p;
      double& value = i < 9 ? affine.columns[static_cast<std::size_t>(i / 3)][i % 3] : affine.translation[i - 9];
      if (!scan_number(p, end, value) || !std::isfinite(value)) {
        fail_at(source_, text.data(), fmt::format("{} is no transform of twelve numbers", quoted(text)));
      }
    }
    return affine;
  }

  Source source_;
  XmlTags tags_;
  Model model_;
  Object* object_ = nullptr;
  std::uint64_t tags_seen_ = 0;
  bool in_mesh_ = false, model_seen_ = false;
};

// ---- The package ----------------------------------------------------------------------------------------------------

class PackageReader {
 public:
  explicit PackageReader(const Source& source) : source_(source), archive_(source), budget_(source) {}

  Mesh read() {
    const std::string path = start_path();
    const Model& start = model(path);
    for (const Reference& item : start.items) place(item, path, {}, 0);
    if (start.items.empty()) {
      for (const auto& [id, object] : start.objects) append(object, {});
    }
    remark_supports();
    mesh_.unit = start.unit;
    return std::move(mesh_);
  }

 private:
  /// The part that _rels/.rels calls the 3D model (Open Packaging Conventions), or the first that looks like one.
  std::string start_path() {
    if (const auto* rels = archive_.find("_rels/.rels")) {
      const std::string text = archive_.extract(*rels);
      const Source part = source_.with(text);
      XmlTags tags(part);
      while (const auto tag = tags.next()) {
        if (tag->name != "Relationship" || !tag->attribute("Type").value_or("").ends_with("/3dmodel")) continue;
        const std::string target(tag->attribute("Target").value_or(""));
        if (archive_.find(target)) return target;
      }
    }
    for (const auto& entry : archive_.entries()) {
      if (entry.name.ends_with(".model")) return std::string(entry.name);
    }
    fail(source_, "is a zip archive without a 3D model; a 3MF file is expected");
  }

  const Model& model(const std::string& path) {
    const auto known = models_.find(path);
    if (known != models_.end()) return known->second;
    const auto* entry = archive_.find(path);
    if (!entry) fail(source_, fmt::format("refers to part {}, which it does not hold", quoted(path)));
    const std::string text = archive_.extract(*entry);
    budget_.add(text.size());
    const std::string name = fmt::format("{}: {}", source_.name, entry->name);
    return models_.emplace(path, ModelParser({text, name, source_.context}).parse()).first->second;
  }

  void append(const Object& object, const PartPlacement& placement) {
    if (is_support(object)) {
      ++supports_;
      support_type_ = object.type;
      return;
    }
    const Mesh& part = object.mesh;
    budget_.spend(part.vertices.size() + part.triangles.size());
    append_placed(source_, part, placement, mesh_);
  }

  void remark_supports() const {
    if (supports_ == 0) return;
    if (mesh_.triangles.empty())
      fail(source_,
           fmt::format("holds nothing but objects of type '{}', which are no part of a model; make them of type "
                       "'model'",
                       support_type_));
    const bool one = supports_ == 1;
    remark(source_, make_finding(FindingCode::objects_left_out, {{"name", std::string(source_.name)},
                                                                 {"count", static_cast<double>(supports_)},
                                                                 {"what", one ? "object" : "objects"},
                                                                 {"type", support_type_},
                                                                 {"were", one ? "was" : "were"},
                                                                 {"them", one ? "it" : "them"}}));
  }

  void place(const Reference& reference, const std::string& here, const PartPlacement& outer, int depth) {
    constexpr int deepest = 200;
    budget_.spend(InstanceBudget::visit);
    if (depth > deepest) fail(source_, "has components that hold each other, or are nested more than 200 deep");
    const std::string& path = reference.path.empty() ? here : reference.path;
    const Model& part = model(path);
    const auto object = part.objects.find(reference.object);
    if (object == part.objects.end()) {
      fail(source_, fmt::format("refers to object {}, which it does not hold", reference.object));
    }
    const PartPlacement placement = outer * reference.placement;
    append(object->second, placement);
    if (is_support(object->second)) return;
    for (const Reference& component : object->second.components) place(component, path, placement, depth + 1);
  }

  const Source& source_;
  ZipArchive archive_;
  InstanceBudget budget_;
  std::map<std::string, Model> models_;
  Mesh mesh_;
  std::size_t supports_ = 0;
  std::string support_type_;
};

}  // namespace

Mesh read_threemf(const Source& source) {
  return PackageReader(source).read();
}

std::string write_threemf(const Mesh& mesh) {
  constexpr std::string_view types =
      R"(<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>
)";
  constexpr std::string_view relations =
      R"(<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>
)";
  std::string model = fmt::format(R"(<?xml version="1.0" encoding="UTF-8"?>
<model unit="{}" xml:lang="en-US" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources><object id="1" type="model"><mesh><vertices>
)",
                                  word_of(mesh.unit.value_or(LengthUnit::millimeter)));
  const bool single = fits_single_precision(mesh);
  model.reserve(model.size() + (single ? 60 : 90) * mesh.vertices.size() + 50 * mesh.triangles.size() + 200);
  for (const Vec3& v : mesh.vertices) {
    append_coordinate(model += "<vertex x=\"", v.x, single);
    append_coordinate(model += "\" y=\"", v.y, single);
    append_coordinate(model += "\" z=\"", v.z, single);
    model += "\"/>\n";
  }
  model += "</vertices><triangles>\n";
  for (const Triangle& t : mesh.triangles) {
    append_number(model += "<triangle v1=\"", std::uint64_t{t[0]});
    append_number(model += "\" v2=\"", std::uint64_t{t[1]});
    append_number(model += "\" v3=\"", std::uint64_t{t[2]});
    model += "\"/>\n";
  }
  model += "</triangles></mesh></object></resources><build><item objectid=\"1\"/></build></model>\n";
  return zip_bytes({{"[Content_Types].xml", types}, {"_rels/.rels", relations}, {"3D/3dmodel.model", model}});
}

}  // namespace evenmesh
