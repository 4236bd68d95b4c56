#include "pipeline/refine.h"

#include <algorithm>
#include <array>
#include <optional>

#include "geometry/single_precision.h"
#include "refine/dislocations.h"
#include "refine/fit.h"
#include "refine/flips.h"
#include "refine/placement.h"
#include "refine/polish.h"
#include "refine/shape_smoothing.h"
#include "refine/untangle.h"
#include "refine/vertex_rings.h"
#include "topology/ball_projector.h"

namespace evenmesh {
namespace {

class Refinement {
 public:
  Refinement(Draft draft, const Tessellation& cells, const Sampler& sampler, const MeshOptions& options,
             ExecutionContext& context)
      : draft_(std::move(draft)), cells_(cells), sampler_(sampler), options_(options), context_(context) {}

  void project() {
    if (options_.placement != Placement::centroid && cells_.sampling.plan.route != Route::wrap) {
      projector_ = sampler_.projector(cells_.sampling.surface(), context_);
      if (!cells_.balls.balls().empty()) projector_ = make_ball_projector(std::move(projector_), cells_.balls);
      const bool everywhere = cells_.sampling.hidden_area > 0;
      if (everywhere || cells_.filled_points.size() > 0)
        projector_ = make_filling_projector(std::move(projector_), cells_.filled_points,
                                            cells_.sampling.samples.grid.spacing, everywhere);
    }
    std::vector<Vec3>& vertices = draft_.mesh.vertices;
    if (projector_)
      parallel_for(context_, vertices.size(), 512, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v)
          if (!draft_.constraints.vertex(static_cast<std::uint32_t>(v)))
            vertices[v] = projector_->project(vertices[v], 0.5 * draft_.sizing.edge(vertices[v]));
      });
    // The shell's rim lies about a voxel beyond that of the sheet.
    const double reach = sampler_.input_mesh() && projector_ ? 3 * cells_.sampling.samples.grid.spacing : 0;
    for (const auto& [v, place] : draft_.boundary) vertices[v] = reach > 0 ? projector_->project(place, reach) : place;
  }

  Refined improve() {
    Mesh& mesh = draft_.mesh;
    VertexConstraints& constraints = draft_.constraints;
    if (!measure_quality(mesh, context_).two_manifold()) {
      const std::size_t pairs = intersections(mesh).size();
      return {moved_back(std::move(mesh)), pairs};
    }
    flip_to_delaunay(mesh, constraints, context_);
    smooth_and_fit();
    finish_projection();
    if (!constraints.curve.empty())
      for (const auto& [s, t] : intersections(mesh)) constraints.release(mesh, std::array{s, t});
    const auto find = [&](const Mesh& m) { return intersections(m); };
    const std::size_t left = untangle(mesh, projector_.get(), find, context_, constraints);
    return {as_checked(moved_back(std::move(mesh))), left};
  }

 private:
  Mesh moved_back(Mesh mesh) const {
    if (const Vec3& origin = sampler_.origin(); origin != Vec3{})
      for (Vec3& v : mesh.vertices) v += origin;
    return mesh;
  }

  /// What does not intersect itself in a file may do so, by the last bits, before it is rounded: then it is rounded
  /// here.
  Mesh as_checked(Mesh mesh) const {
    if (fits_single_precision(mesh) && !self_intersections(mesh, context_).empty())
      mesh.vertices = in_single_precision(mesh.vertices);
    return mesh;
  }

  /// Files hold single precision where it is near enough: what matters is that the mesh written does not intersect
  /// itself.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> intersections(Mesh mesh) const {
    mesh = moved_back(std::move(mesh));
    if (fits_single_precision(mesh)) mesh.vertices = in_single_precision(mesh.vertices);
    return self_intersections(mesh, context_);
  }

  void smooth() {
    constexpr std::size_t evaluations = 20, of_smooth_ones = 10, thorough = 40;
    smooth(options_.quality == Quality::high ? thorough : cells_.seeds_are_vertices ? of_smooth_ones : evaluations);
  }
  void smooth(std::size_t evaluations) {
    Mesh& mesh = draft_.mesh;
    const std::vector<Vec3> before = mesh.vertices;
    const ShapeSmoothingOptions options{
        .size_weight = size_weight_of(options_.evenness), .evaluations = evaluations, .planes = draft_.planes};
    smooth_shapes(mesh, projector_.get(), draft_.sizing, options, context_, draft_.constraints);
    undo_intersections(mesh, before, [&](const Mesh& m) { return intersections(m); });
  }

  /// More regular connectivity may not reach as far into corners and claws as what there was: where fitting leaves it
  /// far off, what reaches farther is taken instead.
  void smooth_and_fit() {
    constexpr double far = 0.32;  // edges
    smooth();
    flip_to_delaunay(draft_.mesh, draft_.constraints, context_);
    std::optional<Draft> smoothed;
    if (!cells_.seeds_are_vertices || options_.quality == Quality::high) {
      smoothed = draft_;
      if (!remove_dislocations()) smoothed.reset();
    }
    const double distance = polish_and_fit();
    if (smoothed && distance > far * draft_.sizing.mean()) take_if_nearer(std::move(*smoothed), distance);
  }
  void take_if_nearer(Draft other, double distance) {
    constexpr double nearer = 0.8;
    std::vector<std::uint32_t> vertex_of_sample;
    std::swap(draft_, other);
    std::swap(vertex_of_sample_, vertex_of_sample);
    if (polish_and_fit() < nearer * distance) return;
    std::swap(draft_, other);
    std::swap(vertex_of_sample_, vertex_of_sample);
  }
  /// @return the largest distance that is left, model units
  double polish_and_fit() {
    polish(draft_.mesh, projector_.get(), context_, draft_.constraints);
    flip_to_delaunay(draft_.mesh, draft_.constraints, context_);
    release_features();
    return options_.placement == Placement::quadric ? fit() : 0;
  }

  /// Where irregular vertices are so many that it is the topology which needs them, they stay. Whether any moved.
  bool remove_dislocations() {
    constexpr double most = 0.3;
    const std::size_t work = annealing_work(options_.quality, draft_.mesh.vertices.size());
    if (work == 0 || measure_quality(draft_.mesh, context_).irregular_ratio > most) return false;
    Mesh mesh = draft_.mesh;
    const DislocationOptions options{
        .work = work, .size_weight = size_weight_of(options_.evenness), .seed = options_.seed};
    const DislocationResult result =
        evenmesh::remove_dislocations(mesh, projector_.get(), draft_.sizing, options, context_, draft_.constraints);
    if (result.accepted == 0 || !intersections(mesh).empty()) return false;
    draft_.mesh = std::move(mesh);
    find_cells();
    smooth();
    flip_to_delaunay(draft_.mesh, draft_.constraints, context_);
    return true;
  }
  /// Of vertices that are no longer those of the seeds.
  void find_cells() {
    const SampleSet& samples = cells_.sampling.surface();
    CpuCellEvaluator(samples, context_).nearest(draft_.mesh.vertices, vertex_of_sample_);
    draft_.planes.clear();
    const auto shapes = cell_shapes(samples, vertex_of_sample_, draft_.mesh.vertices, context_);
    for (std::size_t v = 0; v < shapes.size(); ++v)
      draft_.planes.push_back({draft_.mesh.vertices[v], shapes[v].planes});
  }

  /// Where curves are so near to each other, or meet at so acute an angle, that triangles between them are slivers,
  /// regular triangles come first.
  void release_features() {
    constexpr double sliver = 0.35;  // angles of 12°
    if (draft_.constraints.curve.empty()) return;
    auto slivers = triangles_below(draft_.mesh, sliver, context_);
    if (slivers.empty()) return;
    const auto thin = triangles_between_rims(draft_.mesh, draft_.constraints, slivers, context_);
    std::erase_if(slivers, [&](std::uint32_t t) { return std::binary_search(thin.begin(), thin.end(), t); });
    if (slivers.empty()) return;
    draft_.constraints.release(draft_.mesh, slivers);
    polish(draft_.mesh, projector_.get(), context_, draft_.constraints);
    flip_to_delaunay(draft_.mesh, draft_.constraints, context_);
  }

  /// @return the largest distance that is left, model units
  double fit() {
    constexpr double sheet_error = 3;  // voxels
    const SampleSet& samples = cells_.sampling.surface();
    if (vertex_of_sample_.empty())
      for (const std::uint32_t label : cells_.labels) vertex_of_sample_.push_back(draft_.vertex_of_label[label]);
    const double error = cells_.sampling.closed() ? 0 : sheet_error * samples.grid.spacing;
    return fit_extremes(draft_.mesh, samples, vertex_of_sample_, projector_.get(), {.sample_error = error}, context_,
                        draft_.constraints)
        .deviation;
  }

  /// What was projected onto the samples only goes the rest of the way.
  void finish_projection() {
    if (!projector_) return;
    Mesh& mesh = draft_.mesh;
    std::vector<Vec3> places = mesh.vertices;
    sampler_.step_onto(places, 0.25 * cells_.sampling.samples.grid.spacing);
    for (std::uint32_t v = 0; v < places.size(); ++v)
      if (!draft_.constraints.vertex(v) && !cells_.was_changed_at(places[v])) mesh.vertices[v] = places[v];
  }

  Draft draft_;
  const Tessellation& cells_;
  const Sampler& sampler_;
  const MeshOptions& options_;
  ExecutionContext& context_;
  std::unique_ptr<Projector> projector_;
  std::vector<std::uint32_t> vertex_of_sample_;  ///< none: that of the sample's cell
};

}  // namespace

Refined refine(Draft draft, const Tessellation& cells, const Sampler& sampler, const MeshOptions& options,
               StageTimer& timer, ExecutionContext& context) {
  Refinement refinement(std::move(draft), cells, sampler, options, context);
  timer.stage("place", 0.05, [&] { refinement.project(); });
  return timer.stage("refine", 0.05, [&] { return refinement.improve(); });
}

}  // namespace evenmesh
