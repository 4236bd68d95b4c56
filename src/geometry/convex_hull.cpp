#include "geometry/convex_hull.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>

namespace evenmesh {
namespace {

class Hull {
 public:
  explicit Hull(std::span<const Vec3> points) : points_(points), face_at_(points.size()) {}

  /// False where the points lie in a plane.
  bool run() {
    if (!begin()) return false;
    // Faces are added behind.
    for (std::uint32_t f = 0; f < faces_.size(); ++f)
      while (faces_[f].alive && !faces_[f].outside.empty()) add(f, farthest(f));
    return true;
  }

  std::vector<Triangle> triangles() const {
    std::vector<Triangle> result;
    for (const Face& face : faces_)
      if (face.alive) result.push_back(face.corner);
    return result;
  }

 private:
  struct Face {
    Triangle corner{};
    std::array<std::uint32_t, 3> beside{};  ///< face across the edge from corner i to the next
    std::vector<std::uint32_t> outside;     ///< points that see it, each in one such list
    bool alive = true;
    bool seen = false;  ///< by the point that is being added
  };
  /// An edge between what the new point sees and what it does not.
  struct Rim {
    std::uint32_t from = 0, to = 0, beyond = 0;
  };

  bool sees(std::uint32_t p, const Triangle& t) const {
    return orient3d(points_[t[0]], points_[t[1]], points_[t[2]], points_[p]) > 0;
  }
  template <typename Wanted>
  std::optional<std::uint32_t> first(const Wanted& wanted) const {
    for (std::uint32_t i = 0; i < points_.size(); ++i)
      if (wanted(points_[i])) return i;
    return {};
  }

  /// A tetrahedron.
  bool begin() {
    if (points_.empty()) return false;
    const Vec3& a = points_[0];
    const auto b = first([&](const Vec3& p) { return p != a; });
    if (!b) return false;
    const auto c = first([&](const Vec3& p) { return !collinear(a, points_[*b], p); });
    if (!c) return false;
    const auto d = first([&](const Vec3& p) { return orient3d(a, points_[*b], points_[*c], p) != 0; });
    if (!d) return false;
    Triangle base{0, *b, *c};
    if (sees(*d, base)) std::swap(base[1], base[2]);
    faces_.push_back({base, {1, 2, 3}, {}});
    for (std::uint32_t i = 0; i < 3; ++i)
      faces_.push_back({{base[(i + 1) % 3], base[i], *d}, {0, 1 + (i + 2) % 3, 1 + (i + 1) % 3}, {}});
    std::vector<std::uint32_t> all(points_.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    hand_out(all, 0);
    return true;
  }

  /// Each point to one of the faces from `first` on that it sees; those that see none are within.
  void hand_out(const std::vector<std::uint32_t>& points, std::size_t first) {
    for (const std::uint32_t p : points)
      for (std::size_t f = first; f < faces_.size(); ++f)
        if (sees(p, faces_[f].corner)) {
          faces_[f].outside.push_back(p);
          break;
        }
  }

  std::uint32_t farthest(std::uint32_t f) const {
    const Triangle& t = faces_[f].corner;
    const Vec3& a = points_[t[0]];
    const Vec3 normal = cross(points_[t[1]] - a, points_[t[2]] - a);
    return *std::max_element(faces_[f].outside.begin(), faces_[f].outside.end(),
                             [&](auto p, auto q) { return dot(points_[p] - a, normal) < dot(points_[q] - a, normal); });
  }

  void add(std::uint32_t seen_first, std::uint32_t p) {
    std::vector<std::uint32_t> seen{seen_first}, left;
    std::vector<Rim> rim;
    faces_[seen_first].seen = true;
    for (std::size_t i = 0; i < seen.size(); ++i)
      for (std::size_t e = 0; e < 3; ++e) {
        const Face& face = faces_[seen[i]];
        const std::uint32_t beyond = face.beside[e];
        if (faces_[beyond].seen) continue;
        if (sees(p, faces_[beyond].corner)) {
          faces_[beyond].seen = true;
          seen.push_back(beyond);
        } else {
          rim.push_back({face.corner[e], face.corner[(e + 1) % 3], beyond});
        }
      }
    for (const std::uint32_t f : seen) {
      left.insert(left.end(), faces_[f].outside.begin(), faces_[f].outside.end());
      faces_[f].outside = {};
      faces_[f].alive = false;
    }
    const std::size_t first_new = faces_.size();
    close(rim, p);
    hand_out(left, first_new);
  }

  /// Joins the new point with the rim, which is one closed walk.
  void close(const std::vector<Rim>& rim, std::uint32_t p) {
    const auto base = static_cast<std::uint32_t>(faces_.size());
    for (std::uint32_t i = 0; i < rim.size(); ++i) face_at_[rim[i].from] = base + i;
    for (const Rim& edge : rim) {
      const auto self = static_cast<std::uint32_t>(faces_.size());
      faces_.push_back({{edge.from, edge.to, p}, {edge.beyond, face_at_[edge.to], 0}, {}});
      Face& beyond = faces_[edge.beyond];
      for (std::size_t e = 0; e < 3; ++e)
        if (beyond.corner[e] == edge.to && beyond.corner[(e + 1) % 3] == edge.from) beyond.beside[e] = self;
    }
    for (std::uint32_t i = 0; i < rim.size(); ++i) faces_[face_at_[rim[i].to]].beside[2] = base + i;
  }

  std::span<const Vec3> points_;
  std::vector<Face> faces_;
  std::vector<std::uint32_t> face_at_;  ///< of a corner of the rim: the new face whose edge begins there
};

}  // namespace

Mesh convex_hull(std::span<const Vec3> points) {
  Mesh mesh;
  Hull hull(points);
  if (!hull.run()) return mesh;
  mesh.vertices.assign(points.begin(), points.end());
  mesh.triangles = hull.triangles();
  return mesh;
}

std::vector<Point2> convex_hull(std::vector<Point2> points) {
  std::sort(points.begin(), points.end(),
            [](const Point2& a, const Point2& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  std::vector<Point2> hull;
  const auto walk = [&](auto begin, auto end) {
    const std::size_t fixed = hull.size();
    for (auto p = begin; p != end; ++p) {
      while (hull.size() >= fixed + 2 && orient2d(hull[hull.size() - 2], hull.back(), *p) <= 0) hull.pop_back();
      hull.push_back(*p);
    }
    if (!hull.empty()) hull.pop_back();  // where the other way begins
  };
  walk(points.begin(), points.end());
  walk(points.rbegin(), points.rend());
  return hull;
}

}  // namespace evenmesh
