#include "geometry/closest_point.h"

#include <cmath>

#include "core/parallel.h"
#include "geometry/embree_scene.h"
#include "geometry/triangle.h"

namespace evenmesh {

struct SurfaceQuery::Data {
  EmbreeScene scene;
  std::vector<std::array<Vec3, 3>> corners;  ///< by triangle: one run of memory per candidate
  double first_radius = 0;                   ///< where a search without a limit starts
  double farthest = 0;                       ///< half diagonal of the mesh's box
};

namespace {

struct Search {
  const std::array<Vec3, 3>* corners;
  Vec3 p;
  ClosestPoint best;
  double scale;      ///< scene units per model unit
  double slack;      ///< by which float boxes and the float copy of p may be off, scene units
  bool any = false;  ///< the first triangle within the radius will do
};

/// The float above x: a radius must never be rounded down.
float rounded_up(double x) {
  return x < std::numeric_limits<float>::max()
             ? std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity())
             : std::numeric_limits<float>::infinity();
}

bool visit(RTCPointQueryFunctionArguments* args) {
  auto& search = *static_cast<Search*>(args->userPtr);
  const auto& [a, b, c] = search.corners[args->primID];
  const Vec3 point = closest_point_on_triangle(search.p, a, b, c);
  const double squared = squared_norm(point - search.p);
  ClosestPoint& best = search.best;
  if (squared > best.squared_distance || (squared == best.squared_distance && args->primID >= best.triangle))
    return false;
  const bool nearer = squared < best.squared_distance;
  best = {point, args->primID, squared};
  if (!nearer) return false;
  if (search.any) {
    args->query->radius = 0;
    return true;
  }
  const float radius = rounded_up(search.scale * std::sqrt(squared) * (1 + 1e-6) + search.slack);
  if (!(radius < args->query->radius)) return false;
  args->query->radius = radius;
  return true;
}

/// The nearest triangle within `radius`, if any.
ClosestPoint search_within(const EmbreeScene& scene, Search search, double radius) {
  const Vec3 local = scene.to_local(search.p);
  RTCPointQuery query{};
  query.x = static_cast<float>(local.x);
  query.y = static_cast<float>(local.y);
  query.z = static_cast<float>(local.z);
  query.radius = rounded_up(search.scale * radius * (1 + 1e-6) + search.slack);
  search.best.squared_distance = std::nextafter(radius * radius, std::numeric_limits<double>::infinity());
  search.best.triangle = ~0u;
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(scene.handle(), &query, &context, visit, &search);
  return search.best.triangle == ~0u ? ClosestPoint{} : search.best;
}

}  // namespace

SurfaceQuery::SurfaceQuery(const Mesh& mesh, ExecutionContext& context) {
  auto data = std::make_shared<Data>(Data{EmbreeScene(mesh, context), {}, 0, 0});
  data->corners.resize(mesh.triangles.size());
  with_threads(context, [&] {
    parallel_for(context, mesh.triangles.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) data->corners[t] = corners_of(mesh, t);
    });
  });
  const Box box = mesh.bounds();
  double area = 0;
  for (const auto& [a, b, c] : data->corners) area += triangle_area(a, b, c);
  data->farthest = 0.5 * box.diagonal();
  // About the length of an edge: most queries come from the surface itself.
  data->first_radius = std::max(std::sqrt(area / static_cast<double>(mesh.triangles.size())), 1e-6 * data->farthest);
  data_ = std::move(data);
}

namespace {

/// @param from_origin  distance of p from the scene's origin, model units
Search search_from(const EmbreeScene& scene, const std::array<Vec3, 3>* corners, const Vec3& p, double from_origin) {
  // Float copies of p and of the corners are both off; p may lie far outside the box.
  return {corners, p, {}, scene.scale(), 2 * EmbreeScene::rounding + scene.scale() * from_origin * 0x1p-22};
}

}  // namespace

ClosestPoint SurfaceQuery::closest(const Vec3& p, double max_distance) const {
  const double from_origin = norm(data_->scene.to_local(p)) / data_->scene.scale();
  const Search search = search_from(data_->scene, data_->corners.data(), p, from_origin);
  const double enough = (from_origin + data_->farthest) * (1 + 1e-9);
  double radius =
      std::isfinite(max_distance) ? max_distance : std::max(data_->first_radius, from_origin - data_->farthest);
  radius = std::min(radius, enough);
  for (;;) {
    const ClosestPoint result = search_within(data_->scene, search, radius);
    if (result.found() || !(radius < std::min(max_distance, enough))) return result;
    radius = std::min({2 * radius, max_distance, enough});
  }
}

bool SurfaceQuery::reaches(const Vec3& p, double distance) const {
  const double from_origin = norm(data_->scene.to_local(p)) / data_->scene.scale();
  if (distance < 0 || from_origin - data_->farthest > distance) return false;
  Search search = search_from(data_->scene, data_->corners.data(), p, from_origin);
  search.any = true;
  return search_within(data_->scene, search, distance).found();
}

}  // namespace evenmesh
