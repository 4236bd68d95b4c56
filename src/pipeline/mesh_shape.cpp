#include "evenmesh/mesh_shape.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "connect/dual_polygons.h"
#include "evenmesh/repair.h"
#include "evenmesh/solid.h"
#include "geometry/half_edges.h"
#include "grid/density.h"
#include "grid/dexels.h"
#include "grid/surface_components.h"
#include "pipeline/cells_to_mesh.h"
#include "pipeline/plan.h"
#include "pipeline/shell_cells.h"
#include "refine/fit.h"
#include "refine/flips.h"
#include "refine/placement.h"
#include "refine/polish.h"
#include "refine/projector.h"
#include "refine/untangle.h"
#include "refine/vertex_constraints.h"
#include "refine/vertex_rings.h"
#include "sample/sample.h"
#include "shape/bounds.h"
#include "shape/field.h"
#include "shape/sampler.h"

namespace evenmesh {
namespace {

void check(const MeshOptions& o) {
  if (o.vertices && o.edge_length) throw InvalidInput("give a vertex count or an edge length, not both");
  if (o.vertices && (*o.vertices < 4 || *o.vertices > 1'000'000'000))
    throw InvalidInput("the vertex count must lie in [4, 1e9]");
  if (o.edge_length && !(*o.edge_length > 0 && std::isfinite(*o.edge_length)))
    throw InvalidInput("the edge length must be a number above 0");
  if (o.resolution && (*o.resolution < 8 || *o.resolution > 8192))
    throw InvalidInput("the resolution must lie in [8, 8192]");
  if (o.thickness && (*o.thickness < 1 || *o.thickness > 20))
    throw InvalidInput("the shell's thickness must lie in [1, 20] voxels");
  if (o.max_cycle < 3 || o.max_cycle > 8) throw InvalidInput("the longest cycle must lie in [3, 8] edges");
  if (o.iterations && *o.iterations > 10'000) throw InvalidInput("the iterations must lie in [0, 10000]");
  if (o.feature_angle && !(*o.feature_angle > 0 && *o.feature_angle < 180))
    throw InvalidInput("the angle of sharp edges must lie in (0, 180) degrees");
  if (!(o.tolerance > 0 && o.tolerance < 1)) throw InvalidInput("the tolerance must lie in (0, 1)");
  if (o.bounds && !(is_finite(o.bounds->lo) && is_finite(o.bounds->hi)) && !o.bounds->empty())
    throw InvalidInput("the bounds are not finite: give six numbers");
  if (o.bounds && o.bounds->empty())
    throw InvalidInput("the bounds are empty: each lower limit must be below its upper one");
}

/// Onto the surface of the shape and the balls united with it.
class RegularizedProjector : public Projector {
 public:
  RegularizedProjector(std::unique_ptr<Projector> inner, const BallIndex& balls)
      : inner_(std::move(inner)), balls_(balls) {}
  Vec3 project(const Vec3& p, double limit) const override {
    const Vec3 q = inner_ ? inner_->project(p, limit) : p, out = balls_.outside(q);
    if (out == q) return q;
    // The shape's own surface is covered here: the spheres count.
    const Vec3 on_sphere = onto_sphere(p, limit);
    return squared_norm(on_sphere - p) <= limit * limit ? on_sphere : p;
  }

 private:
  /// From outside the nearest sphere within the limit, from inside the way out.
  Vec3 onto_sphere(const Vec3& p, double limit) const {
    double nearest = limit;
    Vec3 best = p;
    balls_.near(p, limit, [&](std::uint32_t b) {
      const Ball& ball = balls_.balls()[b];
      const Vec3 d = p - ball.center;
      const double length = norm(d), distance = length - ball.radius;
      if (length > 0 && distance > 0 && distance < nearest)
        nearest = distance, best = ball.center + d * (ball.radius / length);
    });
    return balls_.outside(best);
  }

  std::unique_ptr<Projector> inner_;
  const BallIndex& balls_;
};

constexpr double min_solidity = 0.6;  ///< of meshes with an inside to speak of

/// Single precision holds areas and energies, products of up to four lengths, of models between these sizes.
constexpr double smallest_model = 1e-8, largest_model = 1e10;

class Job {
 public:
  Job(const Shape& shape, const MeshOptions& options, ExecutionContext& context, Artifacts& kept)
      : shape_(shape),
        options_(options),
        context_(context),
        kept_(kept),
        timer_(context, report_),
        by_shell_(wants_shell(shape, options, context)) {}

  MeshResult result() {
    ConnectedCells& cells = cells_;
    find_shape_bounds();
    cells = by_shell_ && !options_.wrap ? cells_of_sheets() : cells_of_solid();
    Mesh mesh = timer_.stage("place", 0.1, [&] { return place(cells); });
    timer_.stage("refine", 0.05, [&] { refine(mesh, cells.labels); });
    timer_.stage("measure", 0.05, [&] { finish(mesh, cells.two_manifold); });
    context_.report("done", 1);
    result_.mesh = std::move(mesh);
    return std::move(result_);
  }

 private:
  static bool wants_shell(const Shape& shape, const MeshOptions& options, ExecutionContext& context) {
    if (options.method == Method::raster && (options.wrap || shape.points()))
      throw InvalidInput("rays need a solid: points and wraps are meshed by the shell method");
    if (options.method == Method::shell || options.wrap || shape.points()) return true;
    if (options.method != Method::automatic) return false;
    if (const Sampler* sampler = shape.sampler()) return sampler->solidity(shape.bounds, context) < min_solidity;
    return shape.mesh() && solidity(*shape.mesh(), context) < min_solidity;
  }

  void find_shape_bounds() {
    if (options_.bounds && shape_.compound()) {
      shape_ = intersect({shape_, shape_from_box(*options_.bounds)});
    } else if (options_.bounds) {
      if (const Mesh* mesh = shape_.mesh(); mesh == nullptr || !contains(*options_.bounds, shape_.bounds))
        shape_.bounds = *options_.bounds;
    } else if (shape_.bounds.empty()) {
      shape_.bounds = timer_.stage("sample", 0, [&] { return find_bounds(shape_); });
    }
    if (shape_.compound()) tighten_bounds();
    const double longest = shape_.bounds.longest_side();
    if (longest > 0 && !(longest >= smallest_model && longest <= largest_model))
      throw UnusableInput(fmt::format("the longest side measures {:.3g}: scale it to lie between {:g} and {:g}",
                                      longest, smallest_model, largest_model));
  }

  /// Booleans leave less than their operands' boxes.
  void tighten_bounds() {
    timer_.stage("sample", 0.02, [&] {
      constexpr std::size_t coarse = 96;
      const SampleSet samples = sample_shape(shape_, make_grid(shape_.bounds, coarse), context_);
      Box box;
      for (const SampleBlock& block : samples.blocks)
        for (std::uint32_t s = block.begin; s < block.end; ++s)
          box.add(samples.block_center(block) + Vec3{samples.x[s], samples.y[s], samples.z[s]});
      const double h = 1.5 * samples.grid.spacing;
      shape_.bounds = common(shape_.bounds, Box{box.lo - Vec3{h, h, h}, box.hi + Vec3{h, h, h}});
    });
  }

  ConnectedCells cells_of_sheets() {
    kept_.dexels.reset();
    ShellSampling sampling = sample_by_shell(shape_, options_, timer_, report_, kept_, context_);
    ConnectedCells cells = connect_shell(sampling, options_, timer_, report_, context_);
    samples_ = std::move(sampling.on_surface);
    return cells;
  }
  ConnectedCells cells_of_solid() {
    if (options_.wrap) {
      samples_ = sample_wrapping(shape_, options_, timer_, report_, kept_, context_);
    } else {
      kept_.shell.reset();
      kept_.shell_cut.reset();
      sample();
    }
    if (kept_.dexels) kept_.dexels = dexels_of(samples_);
    return relax_and_connect(samples_, report_.seeds_asked, options_, timer_, report_, context_);
  }

  void sample() {
    const Box& bounds = shape_.bounds;
    const SurfaceScale scale =
        timer_.stage("sample", 0.02, [&] { return presample(shape_, options_.resolution.value_or(0), context_); });
    Fineness fineness = choose_fineness(scale, bounds, options_, report_.notices);
    sample_at(fineness.resolution);
    const double h = samples_.grid.spacing, expected = scale.area * scale.samples_per_area / (h * h);
    const double surprise = static_cast<double>(samples_.size()) / expected;
    if (!options_.resolution && (surprise > 2 || surprise < 0.6)) sample_again(fineness);
    weigh(fineness);
    if (scale.small_components > 0 || surprise > 2) drop_small(fineness.vertices);
    report_.seeds_asked = fineness.vertices;
    report_.resolution = fineness.resolution;
    report_.spacing = samples_.grid.spacing;
    report_.samples = samples_.size();
    report_.disagreements = samples_.disagreements;
    if (samples_.disagreements > 0)
      notice(false, fmt::format("the input is not closed: inside or outside was settled by vote at {} grid points",
                                samples_.disagreements));
    if (const std::size_t count = non_finite_values(shape_); count > 0)
      notice(false,
             fmt::format("{}: not a finite number at {} points, which were taken as outside", shape_.name, count));
    if (samples_.cut_by_bounds && !shape_.capped_by_bounds)
      notice(false, "the solid leaves its bounds and is closed there");
  }

  void sample_at(std::size_t resolution) {
    samples_ = timer_.stage("sample", 0.1,
                            [&] { return sample_shape(shape_, make_grid(shape_.bounds, resolution), context_); });
    if (options_.fill_cavities)
      timer_.stage("sample", 0, [&] {
        RemainingSurface filled = fill_cavities(std::move(samples_), context_);
        samples_ = std::move(filled.samples);
        report_.filled_cavities = filled.dropped;
      });
  }

  /// Fractals have more area the closer one looks, and thin parts may have been seen in pieces only.
  void sample_again(Fineness& fineness) {
    constexpr double wanted_alpha = 150;
    for (int attempt = 0; attempt < 4; ++attempt) {
      const double alpha = static_cast<double>(samples_.size()) / static_cast<double>(fineness.vertices);
      if (alpha > 0.6 * wanted_alpha && alpha < 1.4 * wanted_alpha) return;
      const double better = static_cast<double>(fineness.resolution) * std::sqrt(wanted_alpha / alpha);
      fineness.resolution = std::clamp<std::size_t>(static_cast<std::size_t>(better), 24, 8192);
      sample_at(fineness.resolution);
    }
  }

  /// Smaller cells need a finer grid.
  void weigh(Fineness& fineness) {
    if (!options_.density) return;
    const auto weigh = [&] {
      return timer_.stage("sample", 0, [&] {
        WeightedSamples weighted = weigh_by_density(std::move(samples_), options_.density, context_);
        samples_ = std::move(weighted.samples);
        return weighted.max_density;
      });
    };
    const double finer = std::sqrt(std::min(16.0, weigh()));
    if (options_.resolution || finer < 1.1) return;
    fineness.resolution = std::min<std::size_t>(8192, static_cast<std::size_t>(finer * double(fineness.resolution)));
    sample_at(fineness.resolution);
    weigh();
  }

  /// Thousands of pieces smaller than a cell would keep seeds busy in vain.
  void drop_small(std::size_t vertices) {
    timer_.stage("sample", 0, [&] {
      const double cell = samples_.total_area / static_cast<double>(vertices);
      RemainingSurface rest = drop_small_components(std::move(samples_), cell, context_);
      samples_ = std::move(rest.samples);
      report_.dropped_components = rest.dropped;
    });
    if (samples_.size() < vertices)
      throw UnusableInput("the surface consists of specks smaller than a cell: ask for more vertices");
  }

  static std::size_t non_finite_values(const Shape& shape) {
    std::size_t count = 0;
    if (const Field* field = shape.field()) count = field->non_finite();
    if (const Compound* compound = shape.compound())
      for (const Shape& operand : compound->operands) count += non_finite_values(operand);
    return count;
  }

  static bool contains(const Box& outer, const Box& inner) {
    return outer.contains(inner.lo) && outer.contains(inner.hi);
  }

  /// Vertices from cells, onto the surface; labels without triangles are left out.
  Mesh place(ConnectedCells& cells) {
    const std::vector<CellShape> shapes = cell_shapes(samples_, cells.labels, cells.seeds, context_);
    if (!by_shell_ || options_.wrap)
      report_.dropped_components += remove_two_triangle_spheres(cells.triangles, cells.seeds.size());
    auto& index = vertex_of_label_;
    index.assign(cells.seeds.size(), 0xffffffffu);
    Mesh mesh;
    for (const Triangle& t : cells.triangles)
      for (const std::uint32_t l : t)
        if (index[l] == 0xffffffffu) index[l] = 0;
    for (std::size_t l = 0; l < index.size(); ++l)
      if (index[l] == 0) {
        index[l] = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(options_.placement == Placement::quadric ? shapes[l].vertex : shapes[l].centroid);
      }
    mesh.triangles.reserve(cells.triangles.size());
    for (const Triangle& t : cells.triangles) mesh.triangles.push_back({index[t[0]], index[t[1]], index[t[2]]});

    separate(mesh);
    edge_ = edge_length_of(samples_.total_area, static_cast<double>(std::max<std::size_t>(4, mesh.vertices.size())));
    constrain_features(mesh, cells);
    if (options_.placement != Placement::centroid && !options_.wrap) {
      projector_ = projector();
      if (!cells.balls.balls().empty())
        projector_ = std::make_unique<RegularizedProjector>(std::move(projector_), cells.balls);
      if (projector_)
        parallel_for(context_, mesh.vertices.size(), 512, [&](std::size_t begin, std::size_t end) {
          for (std::size_t v = begin; v < end; ++v)
            if (!constraints_.vertex(static_cast<std::uint32_t>(v)))
              mesh.vertices[v] = projector_->project(mesh.vertices[v], 0.5 * edge_);
        });
    }
    for (const auto& [label, place] : cells.anchors)
      if (const std::uint32_t v = index[label]; v != 0xffffffffu && at_rim_[v]) mesh.vertices[v] = place;
    return mesh;
  }

  /// Whether single points of the shape are dear or cannot be had at all.
  bool by_samples() const {
    const Field* field = shape_.field();
    return shape_.compound() || shape_.sampler() || (field && prefers_batches(*field) && field->has_gradient());
  }

  /// Onto the shape itself or onto the samples.
  std::unique_ptr<Projector> projector() const {
    return by_samples() ? make_projector(samples_) : make_projector(shape_, shape_.bounds, context_);
  }

  /// Vertices of seeds on creases go there, except where a ball has covered the crease.
  void constrain_features(Mesh& mesh, ConnectedCells& cells) {
    const FeatureSeeds& seeds = cells.feature_seeds;
    if (seeds.places.empty() && cells.features.apexes.empty()) return;
    constraints_.curve.assign(mesh.vertices.size(), VertexConstraints::free);
    for (std::size_t l = 0; l < seeds.places.size(); ++l) {
      const Vec3& place = seeds.places[l];
      if (const std::uint32_t v = vertex_of_label_[l]; v != 0xffffffffu && cells.balls.outside(place) == place)
        constraints_.curve[v] = l < seeds.corners ? VertexConstraints::corner : seeds.curve_of(l),
        mesh.vertices[v] = place;
    }
    for (const auto& [a, b] : seeds.edges) {
      const auto [v, w] = std::minmax(vertex_of_label_[a], vertex_of_label_[b]);
      if (w != 0xffffffffu) constraints_.edges.push_back({v, w});
    }
    std::sort(constraints_.edges.begin(), constraints_.edges.end());
    constraints_.features = std::move(cells.features);
    for (const Vec3& apex : constraints_.features.apexes)
      if (cells.balls.outside(apex) == apex) constrain_apex(mesh, apex);
    constraints_.max_chordal_deviation = feature_deviation * edge_;
  }

  /// The nearest vertex goes to the tip of a cone: seeds in balance leave it not far from there.
  void constrain_apex(Mesh& mesh, const Vec3& apex) {
    constexpr double max_moved = 1;  // edges
    std::size_t nearest = 0;
    for (std::size_t v = 1; v < mesh.vertices.size(); ++v)
      if (squared_norm(mesh.vertices[v] - apex) < squared_norm(mesh.vertices[nearest] - apex)) nearest = v;
    if (constraints_.curve[nearest] != VertexConstraints::free ||
        norm(mesh.vertices[nearest] - apex) > max_moved * edge_)
      return;
    constraints_.curve[nearest] = VertexConstraints::corner, mesh.vertices[nearest] = apex;
  }

  /// Open surfaces and fragments: vertices in which several fans of triangles meet are split, and the rim is marked.
  void separate(Mesh& mesh) {
    at_rim_.assign(mesh.vertices.size(), 0);
    const bool closed = !by_shell_ || options_.wrap;
    if (closed && options_.connect != Connect::fragments) return;
    std::vector<std::uint32_t> source;
    report_.cuts += separate_umbrellas(mesh, source);
    const HalfEdges edges(mesh.triangles, mesh.vertices.size());
    for (std::size_t h = 0; h < 3 * mesh.triangles.size(); ++h)
      if (edges.opposite(h) == HalfEdges::none)
        for (const std::size_t c : {h % 3, (h + 1) % 3}) at_rim_[source[mesh.triangles[h / 3][c]]] = 1;
  }

  void refine(Mesh& mesh, std::vector<std::uint32_t>& labels) {
    if (!measure_quality(mesh, context_).two_manifold()) return;
    flip_to_delaunay(mesh, constraints_);
    polish(mesh, projector_.get(), context_, constraints_);
    flip_to_delaunay(mesh, constraints_);
    release_features(mesh);
    if (options_.placement == Placement::quadric) {
      for (std::uint32_t& l : labels) l = vertex_of_label_[l];
      fit_extremes(mesh, samples_, labels, projector_.get(), by_shell_ && !options_.wrap ? 3 * report_.spacing : 0,
                   context_, constraints_);
    }
    project(mesh);
    // Files hold single precision: what matters is that the mesh written does not intersect itself.
    const auto find = [&](Mesh m) {
      for (Vec3& v : m.vertices)
        for (int a = 0; a < 3; ++a) v[a] = static_cast<float>(v[a]);
      return self_intersections(m, context_);
    };
    if (!constraints_.curve.empty())
      for (const auto& [s, t] : find(mesh)) constraints_.release(mesh, std::array{s, t});
    report_.self_intersections = untangle(mesh, projector_.get(), find, context_, constraints_);
  }

  /// What was projected onto the samples only goes the rest of the way.
  void project(Mesh& mesh) const {
    if (!projector_ || shape_.field() == nullptr || !by_samples()) return;
    std::vector<Vec3> places = mesh.vertices;
    step_onto(places, *shape_.field(), shape_.bounds, 0.25 * samples_.grid.spacing);
    for (std::uint32_t v = 0; v < places.size(); ++v)
      if (!constraints_.vertex(v) && cells_.balls.outside(places[v]) == places[v]) mesh.vertices[v] = places[v];
  }

  /// Where creases are so near to each other, or meet at so acute an angle, that triangles between them are slivers,
  /// regular triangles come first.
  void release_features(Mesh& mesh) {
    constexpr double sliver = 0.35;  // angles of 12°
    if (constraints_.curve.empty()) return;
    const auto slivers = triangles_below(mesh, sliver);
    if (slivers.empty()) return;
    constraints_.release(mesh, slivers);
    polish(mesh, projector_.get(), context_, constraints_);
    flip_to_delaunay(mesh, constraints_);
  }

  void finish(const Mesh& mesh, bool two_manifold) {
    report_.quality = measure_quality(mesh, context_);
    const MeshQuality& q = report_.quality;
    report_.seeds = q.vertices;
    report_.alpha = static_cast<double>(report_.samples) / static_cast<double>(std::max<std::size_t>(1, q.vertices));
    report_.evaluations = report_.energies.size();
    if (q.faces == 0)
      throw UnusableInput("no piece of the surface is large enough for this fineness: ask for more vertices");
    if (report_.dropped_components > 0)
      notice(false, fmt::format("{} pieces of surface smaller than a cell were left out", report_.dropped_components));
    if (const std::size_t balls = cells_.balls.balls().size(); balls > 0)
      notice(false,
             fmt::format("{}: {} balls of half an edge or more were united with the solid there",
                         options_.topology == TopologyRule::simplify
                             ? "the topology was made simpler where it needs more vertices"
                             : "the surface comes closer to itself than the grid can tell, or ends in detail that it "
                               "cannot",
                         balls));
    if (by_shell_ && !options_.wrap) {
      if (options_.connect == Connect::fragments && !two_manifold)
        notice(true,
               "the cells do not fit together everywhere: the mesh has cuts or holes there; ask for more vertices");
      if (!q.two_manifold() || !q.oriented())
        notice(true, fmt::format("the mesh is not a two-manifold: {} non-manifold edges; ask for more vertices",
                                 q.non_manifold_edges));
    } else if (!q.closed() || !q.two_manifold() || !q.oriented())
      notice(true,
             fmt::format(
                 "the mesh is not a closed two-manifold: {} boundary and {} non-manifold edges; ask for more vertices",
                 q.boundary_edges, q.non_manifold_edges));
    if (report_.self_intersections > 0)
      notice(true, fmt::format("{} pairs of triangles intersect each other; ask for more vertices",
                               report_.self_intersections));
    if (q.degenerate_faces > 0)
      notice(true, fmt::format("{} triangles have no area; ask for more vertices", q.degenerate_faces));
    const double asked = static_cast<double>(report_.seeds_asked), made = static_cast<double>(q.vertices);
    if (std::abs(made - asked) > 0.005 * asked)
      notice(false, fmt::format("{:.0f} vertices instead of {:.0f}: the topology {}", made, asked,
                                made > asked ? "needs more" : "leaves room for fewer"));
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    report_.peak_memory_bytes = static_cast<std::size_t>(usage.ru_maxrss) * 1024;
  }

  void notice(bool broken, std::string text) { report_.notices.push_back({broken, std::move(text)}); }

  Shape shape_;
  const MeshOptions& options_;
  ExecutionContext& context_;
  Artifacts& kept_;
  MeshResult result_;
  Report& report_ = result_.report;
  StageTimer timer_;
  bool by_shell_;
  SampleSet samples_;
  ConnectedCells cells_;
  std::unique_ptr<Projector> projector_;
  VertexConstraints constraints_;
  std::vector<char> at_rim_;                    ///< by vertex of a label
  std::vector<std::uint32_t> vertex_of_label_;  ///< 0xffffffff: none, its piece of surface is dust
  double edge_ = 0;
};

}  // namespace

MeshResult mesh_shape(const Shape& shape, const MeshOptions& options, ExecutionContext& context, Artifacts* kept) {
  check(options);
  Artifacts none;
  return with_threads(context, [&] { return Job(shape, options, context, kept ? *kept : none).result(); });
}

}  // namespace evenmesh
