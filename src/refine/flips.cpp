#include "refine/flips.h"

#include <vector>

#include "core/parallel.h"
#include "geometry/half_edges.h"

namespace evenmesh {
namespace {

double cotangent_at(const Vec3& apex, const Vec3& a, const Vec3& b) {
  const Vec3 u = a - apex, v = b - apex;
  return dot(u, v) / std::max(norm(cross(u, v)), 1e-300);
}

class Flipper {
 public:
  Flipper(Mesh& mesh, const VertexConstraints& constraints, const ExecutionContext& context)
      : mesh_(mesh), constraints_(constraints), context_(context), opposite_(3 * mesh.triangles.size()) {
    const HalfEdges edges(mesh.triangles, mesh.vertices.size(), context);
    parallel_for(context, opposite_.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t h = begin; h < end; ++h) opposite_[h] = edges.opposite(h);
    });
  }

  /// Edge by edge, then those around the edges that were flipped. What an edge's two triangles alone decide is looked
  /// at in parallel beforehand, which leaves little to do in order.
  std::size_t run() {
    const std::vector<First> first = first_look();
    touched_.assign(mesh_.triangles.size(), 0);
    for (std::uint32_t h = 0; h < first.size() && flips_ < limit(); ++h) {
      if (first[h] == First::other_half) continue;
      const std::uint32_t o = opposite_[h];
      const bool known = o != HalfEdges::none && !touched_[h / 3] && !touched_[o / 3];
      if (known ? first[h] == First::flip && may_flip(h) : wants_flip(h) && may_flip(h)) flip(h);
    }
    for (std::size_t at = 0; at < queue_.size() && flips_ < limit(); ++at)
      if (wants_flip(queue_[at]) && may_flip(queue_[at])) flip(queue_[at]);
    return flips_;
  }

 private:
  static constexpr std::size_t grain = 2048;
  /// What is known of a half-edge before the first flip.
  enum class First : char { other_half, leave, flip };

  std::vector<First> first_look() const {
    std::vector<First> first(opposite_.size(), First::other_half);
    parallel_for(context_, first.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (auto h = static_cast<std::uint32_t>(begin); h < end; ++h)
        if (h < opposite_[h]) first[h] = wants_flip(h) ? First::flip : First::leave;
    });
    return first;
  }

  std::size_t limit() const { return 10 * mesh_.triangles.size(); }
  std::uint32_t start(std::uint32_t h) const { return mesh_.triangles[h / 3][h % 3]; }
  std::uint32_t apex(std::uint32_t h) const { return start(HalfEdges::previous(h)); }
  const Vec3& position(std::uint32_t v) const { return mesh_.vertices[v]; }

  /// As far as the two triangles can tell.
  bool wants_flip(std::uint32_t h) const {
    const std::uint32_t o = opposite_[h];
    if (o == HalfEdges::none) return false;
    const std::uint32_t a = start(h), b = start(o), c = apex(h), d = apex(o);
    if (c == d || constraints_.edge(a, b)) return false;
    const Vec3 &pa = position(a), &pb = position(b), &pc = position(c), &pd = position(d);
    if (cotangent_at(pc, pa, pb) + cotangent_at(pd, pa, pb) >= -1e-9) return false;
    const Vec3 cross1 = cross(pb - pa, pc - pa), cross2 = cross(pa - pb, pd - pb);
    // A triangle without area, as three vertices on a straight feature curve make, has no say in where the others face.
    const double least = 1e-9 * squared_norm(pb - pa);
    const Vec3 old1 = normalized(norm(cross1) > least ? cross1 : cross2);
    const Vec3 old2 = normalized(norm(cross2) > least ? cross2 : cross1);
    const Vec3 new1 = normalized(cross(pd - pc, pa - pc)) * -1.0, new2 = normalized(cross(pc - pd, pb - pd)) * -1.0;
    for (const Vec3& n : {new1, new2})
      if (dot(n, old1) < 0.5 || dot(n, old2) < 0.5) return false;
    return true;
  }
  /// As far as the triangles around can tell.
  bool may_flip(std::uint32_t h) const {
    const std::uint32_t o = opposite_[h];
    return !joined(h, apex(o)) && valence(h) > 3 && valence(o) > 3;
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
    set(h, d);
    set(hn, c);
    set(hp, a);
    set(o, c);
    set(on, d);
    set(op, b);
    link(hn, ca);
    link(hp, ad);
    link(on, db);
    link(op, bc);
    link(h, o);
    ++flips_;
    touched_[h / 3] = 1;
    touched_[o / 3] = 1;
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      queue_.push_back(3 * (h / 3) + corner);
      queue_.push_back(3 * (o / 3) + corner);
    }
  }

  Mesh& mesh_;
  const VertexConstraints& constraints_;
  const ExecutionContext& context_;
  std::vector<std::uint32_t> opposite_;
  std::vector<std::uint32_t> queue_;  ///< half-edges of the triangles that flips have made
  std::vector<char> touched_;         ///< by triangle: a flip has made it
  std::size_t flips_ = 0;
};

}  // namespace

std::size_t flip_to_delaunay(Mesh& mesh, const VertexConstraints& constraints, const ExecutionContext& context) {
  return Flipper(mesh, constraints, context).run();
}

}  // namespace evenmesh
