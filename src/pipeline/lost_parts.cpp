#include "pipeline/lost_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "geometry/closest_point.h"
#include "geometry/triangle.h"
#include "geometry/union_find.h"
#include "grid/inside_runs.h"

namespace evenmesh {
namespace {

constexpr double points_per_edge_area = 2;  ///< of the input, per squared edge
constexpr double max_points = 2e6;

/// A point of the input, and the piece that it is of.
struct InputPoint {
  ThinSpot spot;
  std::uint32_t piece = 0;
};

class Search {
 public:
  Search(const Sampler& sampler, const Sampling& sampling, const Mesh& mesh, ExecutionContext& context)
      : sampler_(sampler),
        sampling_(sampling),
        context_(context),
        edge_(edge_length_of(sampling.samples.total_area, static_cast<double>(sampling.plan.vertices))),
        surface_(mesh, context) {}

  /// What the samples missed between grid points.
  void thin_parts_missed(LostParts& lost) const {
    if (sampling_.thin.empty()) return;
    std::vector<ThinSpot> missing = sampling_.thin;
    std::erase_if(missing, [](const ThinSpot& spot) { return spot.sampled; });
    if (!sampling_.unresolvable()) missing = far_from_mesh(missing);
    const ThinParts parts = thin_parts(missing, edge_);
    if (parts.area < min_missed_area * edge_ * edge_) return;
    auto values = values_of(parts);
    values.insert(values.begin(), {{"what", std::string(parts.gaps ? "gaps filled" : "walls lost")},
                                   {"thickness", parts.thickness},
                                   {"least", parts.least},
                                   {"spacing", sampling_.samples.grid.spacing},
                                   {"cure", cure_for(parts.least)}});
    lost.findings.push_back(
        make_finding(FindingCode::thin_parts_lost, std::move(values), 0.5 * (parts.largest.lo + parts.largest.hi)));
  }

  /// What of the input lies beside the mesh, whatever the reason.
  void pieces_missed(const Mesh& input, LostParts& lost) const {
    const std::vector<InputPoint> points = points_of(input);
    std::vector<char> missing = beside_mesh(points);
    if (sampling_.closed()) leave_out_inner(points, missing);
    std::vector<ThinSpot> spots;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (missing[i]) spots.push_back(points[i].spot);
    if (spots.empty()) return;
    const ThinParts parts = thin_parts(spots, 2 * edge_);
    if (parts.area < min_missed_area * edge_ * edge_) {
      lost.small = whole_pieces(points, missing);
      return;
    }
    auto values = values_of(parts);
    values.push_back({"cure", std::string("ask for more vertices or a finer grid (-r)") +
                                  (sampling_.closed() ? ", or for a surface (--method shell)" : "")});
    lost.findings.push_back(
        make_finding(FindingCode::parts_lost, std::move(values), 0.5 * (parts.largest.lo + parts.largest.hi)));
  }

 private:
  using Values = std::vector<std::pair<std::string, FindingValue>>;

  static Values values_of(const ThinParts& parts) {
    const Vec3 size = parts.largest.hi - parts.largest.lo;
    return {{"parts", static_cast<double>(parts.parts)},
            {"area", parts.area},
            {"dx", size.x},
            {"dy", size.y},
            {"dz", size.z}};
  }

  std::string cure_for(double thickness) const {
    const double planned = static_cast<double>(sampling_.plan.grid.resolution);
    const double resolution = resolution_for(thickness, sampling_);
    if (resolution > static_cast<double>(max_resolution))
      return fmt::format("no grid is fine enough; -r {} keeps what is thicker than {:.2g}", max_resolution,
                         cells_across_wall * sampling_.samples.grid.spacing * planned / double(max_resolution));
    const double finer = resolution / planned, samples = static_cast<double>(sampling_.sampled + sampling_.unresolved);
    const double vertices = round_up(samples * finer * finer / affordable_alpha);
    if (!sampling_.plan.refinable || vertices <= static_cast<double>(sampling_.plan.vertices))
      return fmt::format("-r {:.0f} keeps them", resolution);
    return fmt::format("about {0:.0f} vertices are needed (-n {0:.0f}), or -r {1:.0f}", vertices, resolution);
  }

  std::vector<ThinSpot> far_from_mesh(const std::vector<ThinSpot>& spots) const {
    std::vector<char> far(spots.size());
    parallel_for(context_, spots.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) far[i] = !surface_.reaches(spots[i].place, 0.5 * edge_);
    });
    std::vector<ThinSpot> left;
    for (std::size_t i = 0; i < spots.size(); ++i)
      if (far[i]) left.push_back(spots[i]);
    return left;
  }

  /// Evenly spread over the triangles, in their order, and one at least on every piece.
  std::vector<InputPoint> points_of(const Mesh& input) const {
    UnionFind joined(input.vertices.size());
    for (const Triangle& t : input.triangles) {
      joined.unite(t[0], t[1]);
      joined.unite(t[0], t[2]);
    }
    double area = 0;
    for (std::size_t t = 0; t < input.triangles.size(); ++t) area += area_of(input, t);
    const double step = std::max(edge_ * edge_ / points_per_edge_area, area / max_points);
    std::vector<InputPoint> points;
    std::vector<char> met(input.vertices.size(), 0);
    double due = 0.5;
    for (std::size_t t = 0; t < input.triangles.size(); ++t) {
      const std::uint32_t piece = joined.find(input.triangles[t][0]);
      const double steps = area_of(input, t) / step;
      due += steps;
      if (due < 1 && !met[piece]) points.push_back({spot_at(input, t, 0.5, 0.25, std::min(step, steps * step)), piece});
      met[piece] = 1;
      for (; due >= 1; due -= 1) points.push_back({spread_over(input, t, points.size(), step), piece});
    }
    return points;
  }
  static double area_of(const Mesh& mesh, std::size_t t) {
    const auto [a, b, c] = corners_of(mesh, t);
    return triangle_area(a, b, c);
  }
  /// @param u, v  in [0, 1): any place of a parallelogram, folded onto the triangle
  static ThinSpot spot_at(const Mesh& mesh, std::size_t t, double u, double v, double area) {
    const auto [a, b, c] = corners_of(mesh, t);
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    return {a + u * (b - a) + v * (c - a), 0, static_cast<float>(area), false, false};
  }
  /// By the additive recurrence of Roberts in two dimensions.
  static ThinSpot spread_over(const Mesh& mesh, std::size_t t, std::size_t number, double area) {
    const double n = static_cast<double>(number) + 0.5, u = 0.7548776662466927 * n, v = 0.5698402909980532 * n;
    return spot_at(mesh, t, u - std::floor(u), v - std::floor(v), area);
  }

  std::vector<char> beside_mesh(const std::vector<InputPoint>& points) const {
    std::vector<char> missing(points.size());
    parallel_for(context_, points.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Vec3& p = points[i].spot.place;
        missing[i] = sampler_.bounds().contains(p) && !surface_.reaches(p, std::max(edge_, sampling_.sizing.edge(p)));
      }
    });
    return missing;
  }

  /// Where bodies overlap their surfaces are not that of the solid.
  void leave_out_inner(const std::vector<InputPoint>& points, std::vector<char>& missing) const {
    if (std::find(missing.begin(), missing.end(), 1) == missing.end()) return;
    const InsideRuns inside(sampling_.samples, context_);
    const Grid& grid = sampling_.samples.grid;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!missing[i]) continue;
      const Vec3 p = (points[i].spot.place - grid.origin) / grid.spacing;
      int count = 0;
      for (int corner = 0; corner < 8; ++corner)
        count += inside(std::int32_t(std::floor(p.x)) + (corner & 1), std::int32_t(std::floor(p.y)) + (corner >> 1 & 1),
                        std::int32_t(std::floor(p.z)) + (corner >> 2));
      missing[i] = count < 8;
    }
  }

  static std::size_t whole_pieces(const std::vector<InputPoint>& points, const std::vector<char>& missing) {
    std::vector<std::pair<std::uint32_t, char>> pieces;
    for (std::size_t i = 0; i < points.size(); ++i) pieces.push_back({points[i].piece, missing[i]});
    std::sort(pieces.begin(), pieces.end());
    std::size_t whole = 0;
    for (std::size_t i = 0; i < pieces.size(); ++i)
      whole += pieces[i].second && (i == 0 || pieces[i - 1].first != pieces[i].first);
    return whole;
  }

  const Sampler& sampler_;
  const Sampling& sampling_;
  ExecutionContext& context_;
  double edge_;
  SurfaceQuery surface_;
};

}  // namespace

LostParts find_lost_parts(const Sampler& sampler, const Sampling& sampling, const Mesh& mesh,
                          const MeshOptions& options, ExecutionContext& context) {
  LostParts lost;
  // A wrap hides what is within, and a simpler topology what is in its way.
  const bool whole = sampling.plan.route != Route::wrap && options.topology != TopologyRule::simplify;
  const Mesh* input = whole ? sampler.mesh() : nullptr;
  if (mesh.triangles.empty() || (sampling.thin.empty() && !input)) return lost;
  const Search search(sampler, sampling, mesh, context);
  search.thin_parts_missed(lost);
  if (input && lost.findings.empty()) search.pieces_missed(*input, lost);
  return lost;
}

}  // namespace evenmesh
