#include "refine/dislocations.h"

#include "core/parallel.h"
#include "geometry/closest_point.h"
#include "refine/editable_mesh.h"
#include "refine/flips.h"
#include "refine/refine_testing.h"
#include "refine/shape_smoothing.h"

namespace evenmesh {
namespace {

const SizingField uniform(1.0);

std::vector<std::uint32_t> neighbour_counts(const Mesh& mesh) {
  std::vector<std::uint32_t> counts(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) ++counts[v];
  return counts;
}

std::size_t irregular(const Mesh& mesh) {
  const std::vector<std::uint32_t> counts = neighbour_counts(mesh);
  return static_cast<std::size_t>(std::count_if(counts.begin(), counts.end(), [](auto n) { return n != 6; }));
}

std::int64_t euler_number(const Mesh& mesh) {
  return static_cast<std::int64_t>(mesh.vertices.size() + mesh.triangles.size()) -
         static_cast<std::int64_t>(edge_count(mesh));
}

double mean_score(const Mesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
    sum += VertexRings::score(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
  return sum / static_cast<double>(mesh.triangles.size());
}

/// A smoothed mesh of cells, and what its vertices lie on.
struct Example {
  Shape shape;
  std::unique_ptr<Projector> projector;
  Mesh mesh;

  Example(Shape from, std::size_t vertices) : shape(std::move(from)) {
    ExecutionContext context(2);
    projector = make_projector(shape, shape.bounds, context);
    mesh = mesh_of_cells(shape, 50, vertices).mesh;
    flip_to_delaunay(mesh);
    smooth_shapes(mesh, projector.get(), uniform, {}, context);
  }
};

Shape torus() {
  return shape_from_mesh(make_torus(1, 0.4, 96, 48));
}

void expect_no_triangle_turned_over(const Mesh& mesh, const Mesh& surface) {
  const SurfaceQuery query(surface);
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Triangle& on = surface.triangles[query.closest((1.0 / 3) * (a + b + c)).triangle];
    const Vec3 facing =
        cross(surface.vertices[on[1]] - surface.vertices[on[0]], surface.vertices[on[2]] - surface.vertices[on[0]]);
    EXPECT_GT(dot(normalized(cross(b - a, c - a)), normalized(facing)), 0.3);
  }
}

TEST(Dislocations, OfATorusVanish) {
  Example example(torus(), 700);
  const Mesh before = example.mesh;
  ExecutionContext context(2);
  const DislocationResult result = remove_dislocations(example.mesh, example.projector.get(), uniform, {}, context);
  const Mesh& mesh = example.mesh;
  EXPECT_EQ(result.irregular_before, irregular(before));
  EXPECT_EQ(result.irregular, irregular(mesh));
  EXPECT_LT(2 * irregular(mesh), irregular(before));
  EXPECT_EQ(mesh.vertices.size(), before.vertices.size());
  expect_closed_manifold(mesh);
  EXPECT_EQ(euler_number(mesh), 0);
  for (const std::uint32_t n : neighbour_counts(mesh)) EXPECT_TRUE(n >= 4 && n <= 8);
  expect_no_triangle_turned_over(mesh, *example.shape.mesh());
  EXPECT_GE(mean_score(mesh), mean_score(before));
  const SurfaceQuery query(*example.shape.mesh());
  for (const Vec3& v : mesh.vertices) EXPECT_LT(query.closest(v).squared_distance, 1e-20);
}

TEST(Dislocations, OfASphereLeaveTwelveFivesAndLittleElse) {
  Example example(gallery_shape("sphere"), 900);
  const std::size_t before = irregular(example.mesh);
  ExecutionContext context(2);
  remove_dislocations(example.mesh, example.projector.get(), uniform, {}, context);
  expect_closed_manifold(example.mesh);
  EXPECT_EQ(euler_number(example.mesh), 2);
  EXPECT_GE(irregular(example.mesh), 12u);
  EXPECT_LE(irregular(example.mesh) - 12, before / 2);
}

TEST(Dislocations, MoveAlikeForAnyNumberOfThreads) {
  Example example(torus(), 1300);  // several parts
  const auto moved = [&](unsigned threads) {
    ExecutionContext context(threads);
    return with_threads(context, [&] {
      Mesh mesh = example.mesh;
      remove_dislocations(mesh, example.projector.get(), uniform, {.work = 10}, context);
      return mesh;
    });
  };
  const Mesh one = moved(1);
  EXPECT_NE(one.triangles, example.mesh.triangles);
  for (const unsigned threads : {3u, 7u}) {
    const Mesh mesh = moved(threads);
    EXPECT_EQ(mesh.vertices, one.vertices);
    EXPECT_EQ(mesh.triangles, one.triangles);
  }
}

using Edge = std::array<std::uint32_t, 2>;

/// Lower vertex first.
std::set<Edge> edges_of(const Mesh& mesh) {
  std::set<Edge> edges;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t c = 0; c < 3; ++c) {
      const auto [a, b] = std::minmax(t[c], t[(c + 1) % 3]);
      edges.insert({a, b});
    }
  return edges;
}

/// Edges that only one triangle has, in its direction.
std::set<Edge> boundary_of(const Mesh& mesh) {
  const HalfEdges edges(mesh.triangles, mesh.vertices.size());
  std::set<Edge> boundary;
  for (std::uint32_t h = 0; h < 3 * mesh.triangles.size(); ++h)
    if (edges.opposite(h) == HalfEdges::none)
      boundary.insert({mesh.triangles[h / 3][h % 3], mesh.triangles[h / 3][(h + 1) % 3]});
  return boundary;
}

/// The diagonals of some squares of two triangles the other way, where that keeps four to eight neighbours.
void flip_at_random(Mesh& mesh, const VertexConstraints& constraints) {
  EditableMesh editable(mesh, 0, ExecutionContext::silent());
  EditJournal journal;
  Random random(3);
  for (int i = 0; i < 400; ++i) {
    const auto h = static_cast<std::uint32_t>(random.below(3 * mesh.triangles.size()));
    const std::uint32_t o = editable.opposite(h);
    if (o == HalfEdges::none) continue;
    const std::uint32_t a = editable.origin(h), b = editable.origin(o), c = editable.apex(h), d = editable.apex(o);
    if (editable.on_boundary(a) || editable.on_boundary(b) || editable.on_boundary(c) || editable.on_boundary(d))
      continue;
    const Vec3 along = editable.position(b) - editable.position(a),
               across = editable.position(d) - editable.position(c);
    if (constraints.edge(a, b) || norm(cross(along, across)) < 0.99 * squared_norm(along) ||
        std::abs(norm(along) - norm(across)) > 1e-9 || editable.joined(c, d))
      continue;
    if (editable.valence(a) < 5 || editable.valence(b) < 5 || editable.valence(c) > 7 || editable.valence(d) > 7)
      continue;
    editable.flip(h, journal);
  }
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) mesh.triangles[t] = editable.corners(t);
}

/// Vertices and edges along the edges of the box [−1, 1]³.
VertexConstraints constraints_of_box(const Mesh& mesh) {
  const auto sides = [&](const Vec3& p) {
    return (std::abs(p.x) > 0.99) + (std::abs(p.y) > 0.99) + (std::abs(p.z) > 0.99);
  };
  VertexConstraints constraints;
  for (const Vec3& v : mesh.vertices)
    constraints.curve.push_back(sides(v) == 3   ? VertexConstraints::corner
                                : sides(v) == 2 ? 0
                                                : VertexConstraints::free);
  for (const Edge& e : edges_of(mesh))
    if (sides(0.5 * (mesh.vertices[e[0]] + mesh.vertices[e[1]])) == 2) constraints.edges.push_back(e);
  return constraints;
}

TEST(Dislocations, LeaveFeaturesAlone) {
  Mesh mesh = make_box({1, 1, 1}, 10);
  const VertexConstraints constraints = constraints_of_box(mesh);
  ASSERT_EQ(constraints.edges.size(), 120u);
  flip_at_random(mesh, constraints);
  const Shape shape = shape_from_mesh(mesh);
  ExecutionContext context(2);
  const auto projector = make_projector(shape, shape.bounds, context);
  const Mesh before = mesh;
  remove_dislocations(mesh, projector.get(), uniform, {}, context, constraints);
  expect_closed_manifold(mesh);
  EXPECT_EQ(mesh.vertices.size(), before.vertices.size());
  EXPECT_LT(irregular(mesh), irregular(before));
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v)
    EXPECT_TRUE(!constraints.vertex(v) || mesh.vertices[v] == before.vertices[v]);
  const std::set<Edge> edges = edges_of(mesh);
  for (const Edge& edge : constraints.edges) EXPECT_TRUE(edges.contains(edge));
  EXPECT_NEAR(volume_of(mesh), 8, 1e-9);
}

TEST(Dislocations, OfASheetKeepItsBoundary) {
  Mesh mesh = make_grid_plane(20, 20, 0.05);
  flip_at_random(mesh, {});
  mesh.vertices.push_back({5, 5, 5});  // which no triangle uses
  const Mesh before = mesh;
  ExecutionContext context(1);
  const DislocationResult result = remove_dislocations(mesh, nullptr, uniform, {}, context);
  EXPECT_LT(2 * result.irregular, result.irregular_before);
  EXPECT_EQ(mesh.vertices.size(), before.vertices.size());
  EXPECT_EQ(mesh.vertices.back(), before.vertices.back());
  EXPECT_EQ(mesh.triangles.size(), before.triangles.size());
  EXPECT_EQ(boundary_of(mesh), boundary_of(before));
  for (const Edge& edge : boundary_of(mesh)) EXPECT_EQ(mesh.vertices[edge[0]], before.vertices[edge[0]]);
  for (const Triangle& t : mesh.triangles)
    EXPECT_GT(cross(mesh.vertices[t[1]] - mesh.vertices[t[0]], mesh.vertices[t[2]] - mesh.vertices[t[0]]).z, 0);
}

TEST(Dislocations, OfNothingAndWithoutWorkChangeNothing) {
  ExecutionContext context(1);
  Mesh none;
  EXPECT_EQ(remove_dislocations(none, nullptr, uniform, {}, context).irregular, 0u);
  Mesh mesh = make_icosphere(3);
  const Mesh before = mesh;
  EXPECT_EQ(remove_dislocations(mesh, nullptr, uniform, {.work = 0}, context).irregular, 12u);
  EXPECT_EQ(mesh.triangles, before.triangles);
  EXPECT_EQ(mesh.vertices, before.vertices);
}

TEST(Dislocations, StopWhenCancelled) {
  ExecutionContext context(1);
  context.cancel();
  Mesh mesh = perturbed_sphere(3, 0.02, 1);
  EXPECT_THROW(remove_dislocations(mesh, nullptr, uniform, {}, context), Cancelled);
}

}  // namespace
}  // namespace evenmesh
