#include "geometry/primitives.h"

#include <map>
#include <numbers>
#include <unordered_map>

#include "evenmesh/error.h"

namespace evenmesh {
namespace {

Mesh make_icosahedron() {
  const double t = std::numbers::phi;
  Mesh mesh;
  mesh.vertices = {{-1, t, 0},  {1, t, 0},  {-1, -t, 0}, {1, -t, 0}, {0, -1, t},  {0, 1, t},
                   {0, -1, -t}, {0, 1, -t}, {t, 0, -1},  {t, 0, 1},  {-t, 0, -1}, {-t, 0, 1}};
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  return mesh;
}

/// Cuts every triangle into four at the middles of its edges.
void subdivide(Mesh& mesh) {
  std::unordered_map<std::uint64_t, std::uint32_t> middles;
  middles.reserve(mesh.triangles.size() * 3 / 2);
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const std::uint64_t key = static_cast<std::uint64_t>(std::min(a, b)) << 32 | std::max(a, b);
    const auto [it, inserted] = middles.try_emplace(key, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (inserted) mesh.vertices.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
    return it->second;
  };
  std::vector<Triangle> finer;
  finer.reserve(mesh.triangles.size() * 4);
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  mesh.triangles = std::move(finer);
}

void project_to_sphere(Mesh& mesh, double radius) {
  for (Vec3& v : mesh.vertices) v = radius * normalized(v);
}

void add_quad(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

}  // namespace

Mesh make_icosphere(int levels, double radius) {
  if (levels < 0 || levels > 10) throw InvalidInput("an icosphere takes 0 to 10 levels of subdivision");
  if (!(radius > 0)) throw InvalidInput("an icosphere takes a radius above 0");
  Mesh mesh = make_icosahedron();
  project_to_sphere(mesh, radius);
  for (int level = 0; level < levels; ++level) {
    subdivide(mesh);
    project_to_sphere(mesh, radius);
  }
  return mesh;
}

Mesh make_torus(double ring_radius, double tube_radius, int around, int across) {
  if (around < 3 || across < 3) throw InvalidInput("a torus takes at least 3 quads in each direction");
  if (!(ring_radius > 0) || !(tube_radius > 0)) throw InvalidInput("a torus takes radii above 0");
  Mesh mesh;
  for (int i = 0; i < around; ++i) {
    const double u = 2 * std::numbers::pi * i / around;
    for (int j = 0; j < across; ++j) {
      const double v = 2 * std::numbers::pi * j / across, r = ring_radius + tube_radius * std::cos(v);
      mesh.vertices.push_back({r * std::cos(u), r * std::sin(u), tube_radius * std::sin(v)});
    }
  }
  const auto id = [&](int i, int j) { return static_cast<std::uint32_t>(i % around * across + j % across); };
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) add_quad(mesh, id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1));
  return mesh;
}

Mesh make_box_around(const Box& box, int cuts) {
  const Vec3 size = box.size();
  if (box.empty() || !(size.x > 0) || !(size.y > 0) || !(size.z > 0))
    throw InvalidInput("a box mesh takes a box that is extended along all three axes");
  if (cuts < 1) throw InvalidInput("a box mesh takes at least 1 cut per side");
  Mesh mesh;
  std::map<std::array<int, 3>, std::uint32_t> ids;  // the surface points of a (cuts + 1)³ lattice
  const auto id = [&](const std::array<int, 3>& at) {
    const auto [it, inserted] = ids.try_emplace(at, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (inserted) {
      Vec3 p;
      for (int k = 0; k < 3; ++k) p[k] = at[k] == cuts ? box.hi[k] : box.lo[k] + size[k] * at[k] / cuts;
      mesh.vertices.push_back(p);
    }
    return it->second;
  };
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const bool upper : {false, true})
      for (int i = 0; i < cuts; ++i)
        for (int j = 0; j < cuts; ++j) {
          const auto corner = [&](int di, int dj) {
            std::array<int, 3> at;
            at[axis] = upper ? cuts : 0;
            at[u] = i + di;
            at[v] = j + dj;
            return id(at);
          };
          const std::uint32_t a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          upper ? add_quad(mesh, a, b, c, d) : add_quad(mesh, a, d, c, b);
        }
  }
  return mesh;
}

Mesh make_box(const Vec3& half_sizes, int cuts) {
  Box box;
  box.add(half_sizes);
  box.add(-half_sizes);
  return make_box_around(box, cuts);
}

Mesh make_tetrahedron(double radius) {
  if (!(radius > 0)) throw InvalidInput("a tetrahedron takes a radius above 0");
  Mesh mesh;
  mesh.vertices = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
  project_to_sphere(mesh, radius);
  return mesh;
}

Mesh make_grid_plane(int nx, int ny, double step) {
  if (nx < 1 || ny < 1 || !(step > 0)) throw InvalidInput("a grid plane takes at least 1 × 1 quads of a size above 0");
  Mesh mesh;
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) mesh.vertices.push_back({i * step, j * step, 0});
  const auto id = [&](int i, int j) { return static_cast<std::uint32_t>(j * (nx + 1) + i); };
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) add_quad(mesh, id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1));
  return mesh;
}

Mesh merged(const Mesh& a, const Mesh& b) {
  Mesh mesh = a;
  const auto shift = static_cast<std::uint32_t>(a.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const Triangle& t : b.triangles) mesh.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  return mesh;
}

Mesh translated(Mesh mesh, const Vec3& offset) {
  for (Vec3& v : mesh.vertices) v += offset;
  return mesh;
}

}  // namespace evenmesh
