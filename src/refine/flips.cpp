#include "refine/flips.h"

#include <vector>

#include "geometry/half_edges.h"

namespace evenmesh {
namespace {

double cotangent_at(const Vec3& apex, const Vec3& a, const Vec3& b) {
  const Vec3 u = a - apex, v = b - apex;
  return dot(u, v) / std::max(norm(cross(u, v)), 1e-300);
}

class Flipper {
 public:
  Flipper(Mesh& mesh, const VertexConstraints& constraints)
      : mesh_(mesh), constraints_(constraints), opposite_(3 * mesh.triangles.size()) {
    const HalfEdges edges(mesh.triangles, mesh.vertices.size());
    for (std::size_t h = 0; h < opposite_.size(); ++h) opposite_[h] = edges.opposite(h);
  }

  std::size_t run() {
    std::size_t flips = 0;
    std::vector<std::uint32_t> queue;
    for (std::uint32_t h = 0; h < opposite_.size(); ++h)
      if (h < opposite_[h]) queue.push_back(h);
    const std::size_t limit = 10 * mesh_.triangles.size();
    for (std::size_t at = 0; at < queue.size() && flips < limit; ++at) {
      const std::uint32_t h = queue[at];
      if (!wants_flip(h)) continue;
      flip(h);
      ++flips;
      const std::uint32_t t = 3 * (h / 3), u = 3 * (opposite_[h] / 3);
      for (std::uint32_t c = 0; c < 3; ++c) queue.push_back(t + c), queue.push_back(u + c);
    }
    return flips;
  }

 private:
  std::uint32_t start(std::uint32_t h) const { return mesh_.triangles[h / 3][h % 3]; }
  std::uint32_t apex(std::uint32_t h) const { return start(HalfEdges::previous(h)); }
  const Vec3& position(std::uint32_t v) const { return mesh_.vertices[v]; }

  bool wants_flip(std::uint32_t h) const {
    const std::uint32_t o = opposite_[h];
    if (o == HalfEdges::none) return false;
    const std::uint32_t a = start(h), b = start(o), c = apex(h), d = apex(o);
    if (c == d || constraints_.edge(a, b)) return false;
    const Vec3 &pa = position(a), &pb = position(b), &pc = position(c), &pd = position(d);
    if (cotangent_at(pc, pa, pb) + cotangent_at(pd, pa, pb) >= -1e-9) return false;
    const Vec3 cross1 = cross(pb - pa, pc - pa), cross2 = cross(pa - pb, pd - pb);
    // A triangle without area, as three vertices on a straight crease make, has no say in where the others face.
    const double least = 1e-9 * squared_norm(pb - pa);
    const Vec3 old1 = normalized(norm(cross1) > least ? cross1 : cross2);
    const Vec3 old2 = normalized(norm(cross2) > least ? cross2 : cross1);
    const Vec3 new1 = normalized(cross(pd - pc, pa - pc)) * -1.0, new2 = normalized(cross(pc - pd, pb - pd)) * -1.0;
    for (const Vec3& n : {new1, new2})
      if (dot(n, old1) < 0.5 || dot(n, old2) < 0.5) return false;
    return !joined(h, d) && valence(h) > 3 && valence(o) > 3;
  }

  /// Calls visit(half-edge) for those that start where h does: all around, or up to the boundary both ways.
  template <typename Visit>
  void around_start(std::uint32_t h, const Visit& visit) const {
    std::uint32_t e = h;
    do {
      visit(e);
      e = opposite_[HalfEdges::previous(e)];
    } while (e != h && e != HalfEdges::none);
    if (e == h) return;
    for (e = opposite_[h]; e != HalfEdges::none; e = opposite_[HalfEdges::next(e)]) visit(HalfEdges::next(e));
  }
  /// Whether the apex of h already has an edge to d.
  bool joined(std::uint32_t h, std::uint32_t d) const {
    bool found = false;
    around_start(HalfEdges::previous(h), [&](std::uint32_t e) {
      found |= start(HalfEdges::next(e)) == d || start(HalfEdges::previous(e)) == d;
    });
    return found;
  }
  /// Number of triangles around the start of h.
  int valence(std::uint32_t h) const {
    int n = 0;
    around_start(h, [&](std::uint32_t) { ++n; });
    return n;
  }

  void link(std::uint32_t h, std::uint32_t o) {
    opposite_[h] = o;
    if (o != HalfEdges::none) opposite_[o] = h;
  }

  /// (a, b, c) and (b, a, d) become (d, c, a) and (c, d, b), in place: h then runs from d to c.
  void flip(std::uint32_t h) {
    const std::uint32_t o = opposite_[h];
    const std::uint32_t hn = HalfEdges::next(h), hp = HalfEdges::previous(h), on = HalfEdges::next(o),
                        op = HalfEdges::previous(o);
    const std::uint32_t a = start(h), b = start(o), c = start(hp), d = start(op);
    const std::uint32_t bc = opposite_[hn], ca = opposite_[hp], ad = opposite_[on], db = opposite_[op];
    const auto set = [&](std::uint32_t e, std::uint32_t v) { mesh_.triangles[e / 3][e % 3] = v; };
    set(h, d), set(hn, c), set(hp, a);
    set(o, c), set(on, d), set(op, b);
    link(hn, ca), link(hp, ad), link(on, db), link(op, bc);
    link(h, o);
  }

  Mesh& mesh_;
  const VertexConstraints& constraints_;
  std::vector<std::uint32_t> opposite_;
};

}  // namespace

std::size_t flip_to_delaunay(Mesh& mesh, const VertexConstraints& constraints) {
  return Flipper(mesh, constraints).run();
}

}  // namespace evenmesh
