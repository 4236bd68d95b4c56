#include "refine/editable_mesh.h"

#include "refine/refine_testing.h"

namespace evenmesh {
namespace {

Mesh mesh_of(const EditableMesh& editable) {
  Mesh mesh;
  for (std::uint32_t v = 0; v < editable.vertex_slots(); ++v) mesh.vertices.push_back(editable.position(v));
  for (std::uint32_t t = 0; t < editable.triangle_slots(); ++t)
    if (editable.triangle_in_use(t)) mesh.triangles.push_back(editable.corners(t));
  return mesh;
}

/// Flips, splits and collapses random edges; never below three neighbours.
class Editor {
 public:
  Editor(const Mesh& mesh, std::size_t room, std::uint64_t seed)
      : mesh_(mesh, room, ExecutionContext::silent()), random_(seed) {
    for (std::uint32_t v = 0; v < mesh_.vertex_slots(); ++v)
      if (!mesh_.vertex_in_use(v)) slots_.vertices.push_back(v);
    for (std::uint32_t t = 0; t < mesh_.triangle_slots(); ++t)
      if (!mesh_.triangle_in_use(t)) slots_.triangles.push_back(t);
  }

  void edit() {
    const auto h = static_cast<std::uint32_t>(random_.below(3 * mesh_.triangle_slots()));
    if (!mesh_.triangle_in_use(h / 3)) return;
    const std::uint32_t o = mesh_.opposite(h), c = mesh_.apex(h), d = mesh_.apex(o), a = mesh_.origin(h);
    switch (random_.below(3)) {
      case 0:
        if (c == d || mesh_.joined(c, d) || mesh_.valence(a) < 4 || mesh_.valence(mesh_.target(h)) < 4) return;
        return mesh_.flip(h, journal);
      case 1:
        if (!mesh_.may_collapse(h) || mesh_.valence(c) < 4 || mesh_.valence(d) < 4) return;
        if (mesh_.valence(a) + mesh_.valence(mesh_.target(h)) < 7) return;
        return mesh_.collapse(h, journal, slots_);
      default:
        if (slots_.vertices.empty() || mesh_.valence(a) < 4) return;
        mesh_.split(h, mesh_.rotated(mesh_.rotated(h)), journal, slots_);
    }
  }

  EditJournal journal;
  const EditableMesh& mesh() const { return mesh_; }

 private:
  EditableMesh mesh_;
  EditableMesh::FreeSlots slots_;
  Random random_;
};

void expect_consistent(const EditableMesh& editable) {
  const Mesh mesh = mesh_of(editable);
  expect_closed_manifold(mesh);
  std::vector<std::uint32_t> neighbours(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) ++neighbours[v];
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    ASSERT_EQ(editable.vertex_in_use(v), neighbours[v] > 0);
    if (!editable.vertex_in_use(v)) continue;
    ASSERT_EQ(editable.valence(v), neighbours[v]);
    ASSERT_EQ(editable.origin(editable.outgoing(v)), v);
  }
}

TEST(EditableMesh, KeepsTheTopologyWhateverIsEdited) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Mesh mesh = seed % 2 ? make_torus(1, 0.35, 16, 8) : make_icosphere(2);
    const std::int64_t euler = seed % 2 ? 0 : 2;
    Editor editor(mesh, 100, seed);
    for (int i = 0; i < 2000; ++i) {
      editor.edit();
      editor.mesh().commit(editor.journal);
    }
    expect_consistent(editor.mesh());
    const Mesh edited = mesh_of(editor.mesh());
    EXPECT_NE(edited.triangles, mesh.triangles);
    EXPECT_EQ(static_cast<std::int64_t>(editor.mesh().vertices_in_use() + edited.triangles.size()) -
                  static_cast<std::int64_t>(edge_count(edited)),
              euler);
  }
}

TEST(EditableMesh, TakesBackWhatIsNotCommitted) {
  Editor editor(make_icosphere(3), 50, 7);
  for (int i = 0; i < 300; ++i) editor.edit();
  editor.mesh().commit(editor.journal);
  for (int round = 0; round < 20; ++round) {
    Editor tried = editor;
    const Mesh before = mesh_of(editor.mesh());
    for (int i = 0; i < 40; ++i) editor.edit();
    editor.mesh().roll_back(editor.journal);
    EXPECT_TRUE(editor.journal.empty());
    EXPECT_EQ(mesh_of(editor.mesh()).triangles, before.triangles);
    EXPECT_EQ(mesh_of(editor.mesh()).vertices, before.vertices);
    expect_consistent(editor.mesh());
    editor = tried;
    for (int i = 0; i < 10; ++i) editor.edit();
    editor.mesh().commit(editor.journal);
  }
}

TEST(EditableMesh, KnowsItsBoundary) {
  const EditableMesh mesh(make_grid_plane(4, 3), 1, ExecutionContext::silent());
  std::size_t boundary = 0;
  for (std::uint32_t v = 0; v < 20; ++v) boundary += mesh.on_boundary(v);
  EXPECT_EQ(boundary, 14u);
}

}  // namespace
}  // namespace evenmesh
