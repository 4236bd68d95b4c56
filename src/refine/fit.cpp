#include "refine/fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/parallel.h"
#include "refine/cell_samples.h"
#include "refine/deviations.h"
#include "refine/fit_attempt.h"
#include "refine/vertex_rings.h"

namespace evenmesh {
namespace {

constexpr double among_the_worst = 0.9;          ///< of the largest deviation: what a round looks at
constexpr double least_deviation = 0.13;         ///< worth looking at, edge lengths
constexpr double least_deviation_of_few = 0.08;  ///< where that concerns hardly anybody
constexpr double near_enough = 0.17;             ///< edge lengths, where it is not few: a move costs shapes around it
constexpr int max_rounds = 40;
constexpr int max_rounds_inexact = 4;              ///< on samples off the surface: later rounds only cost quality
constexpr int max_perturbations = 4;               ///< rounds around the worst where nothing helps there
constexpr double worth_another = 0.98;             ///< of the largest deviation: what such a round must have brought
constexpr std::size_t always_worth_another = 100;  ///< attempts: with fewer it costs little

class Fit {
 public:
  Fit(Mesh& mesh, const SampleSet& samples, std::span<const std::uint32_t> vertex_of_sample, const Projector* projector,
      const FitOptions& options, ExecutionContext& context, const VertexConstraints& constraints)
      : mesh_(mesh),
        options_(options),
        context_(context),
        rings_(std::in_place, mesh, context),
        cells_(samples, vertex_of_sample, mesh, *rings_, options.sample_error > 0 ? projector : nullptr,
               options.sample_error, context),
        gaps_(std::in_place, mesh, *rings_, projector, least_deviation),
        deviations_(mesh.vertices.size()),
        state_{mesh, *rings_, cells_, projector, constraints, deviations_, least_deviation},
        taken_(mesh.vertices.size()) {}

  FitResult run() {
    measure();
    edge_ = mean_edge();
    result_.deviation_before = std::sqrt(deviations_.largest());
    const int rounds = options_.sample_error > 0 ? max_rounds_inexact : max_rounds;
    int perturbations = 0;
    bool perturb = false;
    double stuck_at = std::numeric_limits<double>::infinity();
    for (int round = 0; round < rounds && result_.moves < max_moves(); ++round) {
      context_.throw_if_cancelled();
      std::vector<std::uint32_t> list =
          perturb ? around_the_stuck(perturbations) : deviations_.largest_first(among_the_worst);
      if (is_near_enough()) break;
      if (!perturb && list.size() > max_extremes()) break;
      const bool moved = try_all(std::move(list));
      deviations_.update(*gaps_, cells_, context_);
      if (!moved) {
        const bool in_vain = deviations_.largest() > worth_another * worth_another * stuck_at;
        if (perturbations == max_perturbations || (in_vain && result_.attempts > always_worth_another)) break;
        stuck_at = deviations_.largest();
      }
      perturb = !moved;
      perturbations += perturb;
    }
    result_.deviation = std::sqrt(deviations_.largest());
    return result_;
  }

 private:
  /// Extremes are few; else the mesh is too coarse. Every move costs the shapes of the triangles around.
  std::size_t max_moves() const { return 260 + mesh_.vertices.size() / 420; }
  std::size_t max_extremes() const { return 5 + mesh_.vertices.size() / 200; }

  double mean_edge() const {
    double sum = 0;
    for (std::uint32_t v = 0; v < mesh_.vertices.size(); ++v) sum += rings_->edge_length(v);
    return sum / static_cast<double>(mesh_.vertices.size());
  }
  bool is_near_enough() const {
    const double limit = near_enough * edge_;
    return state_.least_deviation > least_deviation_of_few && deviations_.largest() < limit * limit;
  }

  /// By some samples everywhere, then by all where it is far, and beside that.
  void measure() {
    deviations_.update(*gaps_, cells_, context_);
    if (deviations_.largest_first(0).size() < mesh_.vertices.size() / 1000) {
      state_.least_deviation = least_deviation_of_few;
      gaps_.emplace(mesh_, *rings_, state_.projector, least_deviation_of_few);
      deviations_.mark_all();
      deviations_.update(*gaps_, cells_, context_);
    }
    std::vector<std::uint32_t> near;
    for (const std::uint32_t v : deviations_.largest_first(0)) {
      near.push_back(v);
      near.insert(near.end(), rings_->neighbours(v).begin(), rings_->neighbours(v).end());
    }
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    cells_.take_all_of(near);
    for (const std::uint32_t v : near) deviations_.mark(v);
    deviations_.update(*gaps_, cells_, context_);
  }

  std::vector<std::uint32_t> around_the_stuck(int perturbation) {
    constexpr std::size_t max_stuck = 2;
    return deviations_.around_the_largest(max_stuck, 2 + perturbation, *rings_);
  }

  /// Whether one of them came nearer.
  bool try_all(std::vector<std::uint32_t> list) {
    constexpr double worth_a_flip = 0.81;  // of the largest squared deviation
    const std::size_t before = result_.moves;
    while (!list.empty()) {
      const std::vector<std::uint32_t> group = take_independent(list);
      const double least_for_flips = worth_a_flip * deviations_.largest();
      std::vector<char> moved(group.size(), 0), flipped(group.size(), 0);
      parallel_tasks(context_, group.size(), [&](std::size_t i) {
        const std::uint32_t v = group[i];
        const bool flips = deviations_[v] >= least_for_flips;
        FitAttempt attempt(state_, v, options_.floor);
        moved[i] = attempt.reach() || (flips && (flipped[i] = attempt.flip())) || attempt.lift();
        if (!moved[i]) deviations_.give_up(v);
      });
      const auto count = [](const std::vector<char>& of) {
        return static_cast<std::size_t>(std::count(of.begin(), of.end(), 1));
      };
      result_.attempts += group.size();
      result_.moves += count(moved);
      result_.flips += count(flipped);
      if (count(flipped) > 0) rings_.emplace(mesh_, context_);
    }
    return result_.moves > before;
  }

  /// Takes those vertices off the list, from the front, that are so far apart that attempts do not meet.
  std::vector<std::uint32_t> take_independent(std::vector<std::uint32_t>& list) {
    std::fill(taken_.begin(), taken_.end(), 0);
    std::vector<std::uint32_t> group, rest;
    for (const std::uint32_t v : list) {
      const auto touched = vertices_around(*rings_, v, FitAttempt::touched_rings);
      const bool meets = std::any_of(touched.begin(), touched.end(), [&](std::uint32_t w) { return taken_[w]; });
      (meets ? rest : group).push_back(v);
      if (!meets)
        for (const std::uint32_t w : touched) taken_[w] = 1;
    }
    list = std::move(rest);
    return group;
  }

  Mesh& mesh_;
  const FitOptions& options_;
  ExecutionContext& context_;
  std::optional<VertexRings> rings_;  ///< made again, in place, when edges were flipped
  CellSamples cells_;
  std::optional<GapFinder> gaps_;
  Deviations deviations_;
  FitState state_;
  double edge_ = 0;          ///< mean length
  std::vector<char> taken_;  ///< by vertex: by attempts of the group
  FitResult result_;
};

}  // namespace

FitResult fit_extremes(Mesh& mesh, const SampleSet& samples, std::span<const std::uint32_t> vertex_of_sample,
                       const Projector* projector, const FitOptions& options, ExecutionContext& context,
                       const VertexConstraints& constraints) {
  if (mesh.triangles.empty()) return {};
  return Fit(mesh, samples, vertex_of_sample, projector, options, context, constraints).run();
}

}  // namespace evenmesh
