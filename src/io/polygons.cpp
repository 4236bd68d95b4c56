#include "io/polygons.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "evenmesh/findings.h"
#include "geometry/ear_clipping.h"

namespace evenmesh {
namespace {

/// Twice the area of a triangle, along its normal.
Vec3 area_normal(const Mesh& mesh, const Triangle& t) {
  const Vec3& a = mesh.vertices[t[0]];
  return cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a);
}

class FanMender {
 public:
  explicit FanMender(Mesh& mesh) : mesh_(mesh) {}

  /// False where the polygon crosses itself, or is too large.
  bool mend(const Fan& fan) {
    const Vec3 normal = normal_of(fan);
    if (covers_its_polygon(fan, normal) || !is_finite(normal)) return true;
    return clip(fan, normal);
  }

 private:
  Vec3 normal_of(const Fan& fan) const {
    Vec3 sum;
    for (std::size_t i = 0; i < fan.count; ++i) sum += area_normal(mesh_, mesh_.triangles[fan.first + i]);
    return sum;
  }

  bool covers_its_polygon(const Fan& fan, const Vec3& normal) const {
    constexpr double rounding = 1e-9;  // of corners on a straight edge
    const double least = -rounding * squared_norm(normal);
    for (std::size_t i = 0; i < fan.count; ++i) {
      const double part = dot(area_normal(mesh_, mesh_.triangles[fan.first + i]), normal);
      if (!(part >= least)) return false;
    }
    return true;
  }

  bool clip(const Fan& fan, const Vec3& normal) {
    const Vec3 size{std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)};
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    std::vector<std::uint32_t> corners{mesh_.triangles[fan.first][0], mesh_.triangles[fan.first][1]};
    for (std::size_t i = 0; i < fan.count; ++i) corners.push_back(mesh_.triangles[fan.first + i][2]);
    const bool turned = normal[axis] < 0;
    if (turned) std::reverse(corners.begin(), corners.end());
    Outline outline{{Contour{}}};
    for (const std::uint32_t v : corners) outline.contours[0].push_back(drop_axis(mesh_.vertices[v], axis));
    const std::optional<std::vector<Triangle>> ears = ear_clipped(outline, steps_);
    if (!ears || ears->size() != fan.count) return false;
    for (std::size_t i = 0; i < fan.count; ++i) {
      const Triangle& ear = (*ears)[i];
      Triangle& t = mesh_.triangles[fan.first + i];
      t = {corners[ear[0]], corners[ear[1]], corners[ear[2]]};
      if (turned) std::swap(t[1], t[2]);
    }
    return true;
  }

  Mesh& mesh_;
  std::size_t steps_ = 1'000'000'000;  ///< of all polygons together, a few seconds
};

}  // namespace

void mend_fans(const Source& source, const std::vector<Fan>& fans, Mesh& mesh) {
  FanMender mender(mesh);
  std::size_t wrong = 0;
  Vec3 place;
  for (std::size_t i = 0; i < fans.size(); ++i) {
    if (i % (1 << 16) == 0) source.context->throw_if_cancelled();
    if (mender.mend(fans[i])) continue;
    if (wrong++ == 0) place = mesh.vertices[mesh.triangles[fans[i].first][0]];
  }
  if (wrong == 0) return;
  remark(source, make_finding(FindingCode::polygons_not_simple,
                              {{"name", std::string(source.name)}, {"count", static_cast<double>(wrong)}}, place));
}

}  // namespace evenmesh
