#include "pipeline/shell_cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "connect/dual_polygons.h"
#include "connect/flood.h"
#include "connect/fragments.h"
#include "geometry/half_edges.h"
#include "pipeline/plan.h"
#include "topology/repair.h"

namespace evenmesh {
namespace {

constexpr int topology_rounds = 12;
constexpr int patience = 3;  ///< fragments: rounds without a fifth fewer defects
constexpr std::size_t relaxing_evaluations = 5;
constexpr double shell_effort =
    1.7;  ///< of balancing, a small part of the time here: Q 0.005 higher for 10 % more of it

class ShellCells {
 public:
  ShellCells(const ShellSampling& sampling, const MeshOptions& options, StageTimer& timer, Report& report,
             ExecutionContext& context)
      : sampling_(sampling),
        samples_(sampling.samples),
        options_(options),
        timer_(timer),
        report_(report),
        context_(context),
        evaluator_(sampling.samples, context) {}

  ConnectedCells result() {
    timer_.stage("balance", 0.5, [&] {
      RelaxOptions balance = relax_options(options_);
      balance.effort *= shell_effort;
      RelaxResult result = relax_seeds(evaluator_, report_.seeds_asked, balance, context_);
      seeds_ = std::move(result.seeds);
      report_.energies.insert(report_.energies.end(), result.ratios.begin(), result.ratios.end());
      report_.energy_ratio = result.energy_ratio;
    });
    connect();
    std::size_t fewest = std::numeric_limits<std::size_t>::max();
    for (int round = 0, idle = 0; round < topology_rounds; ++round) {
      const auto found = defects();
      if (found.empty()) break;
      // Sheets closer than the samples can tell stay together, however many seeds there are.
      idle = 10 * found.size() < 8 * fewest ? 0 : idle + 1;
      fewest = std::min(fewest, found.size());
      if (options_.connect == Connect::fragments && idle > patience) break;
      repair_topology(found);
    }
    if (options_.topology == TopologyRule::simplify)
      report_.notices.push_back({false, "sheets have no inside that balls could be added to: their topology was kept"});
    ConnectedCells cells;
    cells.two_manifold = complex_.defects.empty();
    report_cycles(complex_, report_, context_);
    cells.anchors = anchors();
    cells.seeds = std::move(seeds_), cells.labels = std::move(labels_);
    cells.triangles = std::move(complex_.triangles);
    return cells;
  }

 private:
  void connect() {
    timer_.stage("connect", 0.1, [&] {
      evaluator_.nearest(seeds_, labels_);
      if (options_.connect == Connect::fragments) {
        connect_as_fragments();
        return;
      }
      std::vector<std::uint32_t> all(sampling_.surface.samples.size(), no_label);
      for (std::size_t i = 0; i < labels_.size(); ++i) all[sampling_.in_surface[i]] = labels_[i];
      if (options_.connect == Connect::flood) flood_labels(sampling_.surface.samples, all, seeds_, context_);
      complex_ = connect_labels(sampling_.surface.samples, all, seeds_, context_);
      for (std::size_t i = 0; i < labels_.size(); ++i) labels_[i] = all[sampling_.in_surface[i]];
      for (const CellComponent& piece : complex_.pieces) seeds_.push_back(piece.centroid);
    });
  }

  /// A boundary away from the rim of the sheets is a hole: a cycle that could not be filled.
  void connect_as_fragments() {
    complex_ = connect_fragments(samples_, seeds_, {.max_cycle = options_.max_cycle, .open = true}, context_).complex;
    std::vector<char> at_rim(seeds_.size(), 0);
    for (std::size_t i = 0; i < labels_.size(); ++i)
      if (sampling_.sheets.border[sampling_.in_surface[i]]) at_rim[labels_[i]] = 1;
    for (const auto& [a, b] : manifold_defects(complex_.triangles, seeds_.size()))
      if (a != b && (!at_rim[a] || !at_rim[b])) complex_.defects.push_back({a, b});
  }

  /// Defects of the complex, and cells that own a good deal of surface but no triangle: small sheets need three seeds.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> defects() const {
    auto list = complex_.defects;
    std::vector<char> connected(seeds_.size(), 0);
    for (const Triangle& t : complex_.triangles)
      for (const std::uint32_t l : t) connected[l] = 1;
    std::vector<double> area(seeds_.size(), 0);
    for (std::size_t i = 0; i < labels_.size(); ++i) area[labels_[i]] += samples_.area[i];
    const double worth_it = 0.5 * samples_.total_area / static_cast<double>(report_.seeds_asked);
    for (std::uint32_t l = 0; l < seeds_.size(); ++l)
      if (!connected[l] && area[l] > worth_it) list.push_back({l, l});
    return list;
  }

  void repair_topology(const std::vector<std::pair<std::uint32_t, std::uint32_t>>& found) {
    const std::size_t given = seeds_.size() - complex_.pieces.size();
    const TopologyRepair repair = timer_.stage("connect", 0, [&] {
      const double edge = edge_length_of(samples_.total_area, static_cast<double>(seeds_.size()));
      return plan_topology_repair(samples_, labels_, seeds_, found, {}, BallIndex({}),
                                  {.edge = edge, .given = given, .seeds_only = true});
    });
    context_.log(fmt::format("mend: {} defects, {} seeds", found.size(), seeds_.size()));
    seeds_.resize(given);
    seeds_.insert(seeds_.end(), repair.seeds.begin(), repair.seeds.end());
    report_.inserted_seeds += repair.seeds.size();
    // Seeds closer than a few samples would all be neighbours to fragments.
    if (options_.connect == Connect::fragments)
      timer_.stage("balance", 0, [&] {
        optimize(evaluator_, seeds_, {options_.optimizer == Optimizer::lloyd, relaxing_evaluations, options_.tolerance},
                 context_);
      });
    connect();
  }

  /// Cells at the rim, and their place on it.
  std::vector<std::pair<std::uint32_t, Vec3>> anchors() const {
    struct Rim {
      Vec3 sum, nearest;
      double count = 0, distance = std::numeric_limits<double>::infinity();
    };
    std::vector<Rim> rims(seeds_.size());
    const auto each = [&](const auto& use) {
      const SampleSet& set = sampling_.on_surface;
      for (const SampleBlock& block : set.blocks)
        for (std::uint32_t i = block.begin; i < block.end; ++i)
          if (sampling_.sheets.border[sampling_.in_surface[i]])
            use(rims[labels_[i]], set.block_center(block) + Vec3{set.x[i], set.y[i], set.z[i]});
    };
    each([](Rim& rim, const Vec3& p) { rim.sum += p, rim.count += 1; });
    each([](Rim& rim, const Vec3& p) {
      if (const double d = squared_norm(p - rim.sum / rim.count); d < rim.distance) rim.distance = d, rim.nearest = p;
    });
    std::vector<std::pair<std::uint32_t, Vec3>> list;
    for (std::uint32_t l = 0; l < rims.size(); ++l)
      if (rims[l].count > 0) list.push_back({l, rims[l].nearest});
    return list;
  }

  const ShellSampling& sampling_;
  const SampleSet& samples_;
  const MeshOptions& options_;
  StageTimer& timer_;
  Report& report_;
  ExecutionContext& context_;
  CellEvaluator evaluator_;
  std::vector<Vec3> seeds_;
  std::vector<std::uint32_t> labels_;
  LabelComplex complex_;
};

}  // namespace

ConnectedCells connect_shell(const ShellSampling& sampling, const MeshOptions& options, StageTimer& timer,
                             Report& report, ExecutionContext& context) {
  return ShellCells(sampling, options, timer, report, context).result();
}

namespace {

/// Gives every triangle but the first on an edge of three and more, or of two that run the same way, corners of its own
/// there.
bool detach_crowded(Mesh& mesh, std::vector<std::uint32_t>& source) {
  std::vector<std::uint64_t> taken;
  const auto key = [](std::uint32_t a, std::uint32_t b) { return std::uint64_t{a} << 32 | b; };
  for (const Triangle& t : mesh.triangles)
    for (std::size_t c = 0; c < 3; ++c) taken.push_back(key(t[c], t[(c + 1) % 3]));
  std::sort(taken.begin(), taken.end());
  std::vector<std::uint64_t> crowded;  // half-edges of several triangles
  for (std::size_t i = 1; i < taken.size(); ++i)
    if (taken[i] == taken[i - 1]) crowded.push_back(taken[i]);
  if (crowded.empty()) return false;
  crowded.erase(std::unique(crowded.begin(), crowded.end()), crowded.end());
  std::vector<char> met(crowded.size(), 0);
  for (Triangle& t : mesh.triangles)
    for (std::size_t c = 0; c < 3; ++c) {
      const auto at = std::lower_bound(crowded.begin(), crowded.end(), key(t[c], t[(c + 1) % 3]));
      if (at == crowded.end() || *at != key(t[c], t[(c + 1) % 3])) continue;
      if (!std::exchange(met[static_cast<std::size_t>(at - crowded.begin())], 1)) continue;
      for (const std::size_t corner : {c, (c + 1) % 3}) {
        source.push_back(source[t[corner]]);
        mesh.vertices.push_back(mesh.vertices[t[corner]]);
        t[corner] = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
      }
    }
  return true;
}

}  // namespace

std::size_t separate_umbrellas(Mesh& mesh, std::vector<std::uint32_t>& source) {
  const std::size_t given = mesh.vertices.size();
  source.resize(given);
  std::iota(source.begin(), source.end(), 0u);
  for (bool again = true; again; again = detach_crowded(mesh, source)) {
    const std::size_t before = mesh.vertices.size();
    const HalfEdges edges(mesh.triangles, before);
    for (std::uint32_t v = 0; v < before; ++v) {
      std::uint32_t copy = v, last_umbrella = 0;
      edges.visit_umbrellas(v, [&](std::uint32_t h, std::uint32_t umbrella) {
        if (umbrella != last_umbrella) {
          last_umbrella = umbrella, copy = static_cast<std::uint32_t>(mesh.vertices.size());
          mesh.vertices.push_back(mesh.vertices[v]), source.push_back(source[v]);
        }
        mesh.triangles[h / 3][h % 3] = copy;
      });
    }
  }
  return mesh.vertices.size() - given;
}

}  // namespace evenmesh
