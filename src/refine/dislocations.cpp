#include "refine/dislocations.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/parallel.h"
#include "core/random.h"
#include "geometry/triangle.h"
#include "refine/dislocation_moves.h"
#include "refine/editable_mesh.h"
#include "refine/mesh_division.h"
#include "refine/reference_points.h"

namespace evenmesh {
namespace {

constexpr std::uint32_t none = EditableMesh::none;
constexpr std::size_t vertices_per_part = 400;
constexpr int rounds = 24;
constexpr double first_temperature = 0.3, last_temperature = 0.01;  ///< energy
constexpr std::size_t least_room = 64, vertices_per_room = 20;      ///< for vertices to be added

class Annealing {
 public:
  Annealing(Mesh& mesh, const Projector* projector, const SizingField& sizing, const DislocationOptions& options,
            ExecutionContext& context, const VertexConstraints& constraints)
      : result_mesh_(mesh),
        options_(options),
        context_(context),
        constraints_(constraints),
        mesh_(mesh, least_room + mesh.vertices.size() / vertices_per_room, context),
        count_(mesh_.vertices_in_use()),
        common_{mesh_, projector, sizing, {options.size_weight}},
        points_(mesh_, projector, context),
        random_(options.seed) {
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v)
      if (!mesh_.vertex_in_use(v)) unused_.push_back(v);
    common_.held.assign(mesh_.vertex_slots(), 0);
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v)
      common_.held[v] = mesh_.vertex_in_use(v) && (mesh_.on_boundary(v) || constraints.vertex(v));
    const double area = common_.find_targets(mesh);
    common_.find_energies();
    edge_ = std::sqrt(area / static_cast<double>(mesh.triangles.size()) * 4 / std::numbers::sqrt3);
  }

  DislocationResult run() {
    result_.irregular_before = irregular_vertices().size();
    for (int round = 0; round < rounds; ++round)
      anneal(first_temperature * std::pow(last_temperature / first_temperature, round / (rounds - 1.0)));
    const bool restored = restore_count();
    result_.irregular = restored ? irregular_vertices().size() : result_.irregular_before;
    if (restored) write_back();
    return result_;
  }

 private:
  std::vector<std::uint32_t> irregular_vertices() const {
    std::vector<std::uint32_t> list;
    for (std::uint32_t v = 0; v < mesh_.vertex_slots(); ++v)
      if (mesh_.vertex_in_use(v) && !mesh_.on_boundary(v) && mesh_.valence(v) != 6) list.push_back(v);
    return list;
  }
  int surplus() const { return static_cast<int>(mesh_.vertices_in_use()) - static_cast<int>(count_); }
  MoveParameters parameters_at(double temperature) const {
    return {
        .irregular_cost = options_.irregular_cost, .temperature = temperature, .tolerance = options_.tolerance * edge_};
  }

  /// Parts for each of which somebody may work alone, and what is not in use shared out among them.
  std::vector<DislocationMoves> divide(std::size_t parts) {
    common_.part = divide_mesh(mesh_, parts, random_);
    common_.vertex_mark.assign(mesh_.vertex_slots(), 0);
    common_.triangle_mark.assign(mesh_.triangle_slots(), 0);
    std::vector<EditableMesh::FreeSlots> slots(parts);
    std::size_t vertices = 0, triangles = 0;
    for (std::uint32_t v = 0; v < mesh_.vertex_slots(); ++v)
      if (!mesh_.vertex_in_use(v) && !std::binary_search(unused_.begin(), unused_.end(), v))
        slots[vertices++ % parts].vertices.push_back(v);
    for (std::uint32_t t = 0; t < mesh_.triangle_slots(); ++t)
      if (!mesh_.triangle_in_use(t)) slots[triangles++ / 2 % parts].triangles.push_back(t);
    const int all = surplus(), n = static_cast<int>(parts);
    std::vector<DislocationMoves> moves;
    moves.reserve(parts);
    for (int p = 0; p < n; ++p)
      moves.emplace_back(common_, points_, constraints_, static_cast<std::uint32_t>(p),
                         std::move(slots[static_cast<std::size_t>(p)]), random_.bits(),
                         all * (p + 1) / n - all * p / n);
    for (const std::uint32_t v : irregular_vertices())
      if (common_.part[v] != none) moves[common_.part[v]].add_irregular(v);
    return moves;
  }

  void anneal(double temperature) {
    std::vector<DislocationMoves> moves = divide(std::max<std::size_t>(1, count_ / vertices_per_part));
    const MoveParameters parameters = parameters_at(temperature);
    parallel_tasks(context_, moves.size(), [&](std::size_t p) {
      const std::size_t tries = moves[p].irregular_count() * options_.work / rounds;
      for (std::size_t i = 0; i < tries && moves[p].irregular_count() > 0; ++i) {
        context_.throw_if_cancelled();
        moves[p].attempt_any(parameters);
      }
    });
    for (const DislocationMoves& m : moves) add(m.counts);
  }
  void add(const MoveCounts& c) {
    result_.attempts += c.attempts;
    result_.relaxed += c.relaxed;
    result_.off_surface += c.off_surface;
    result_.accepted += c.accepted;
  }

  /// Splits or collapses, ever dearer ones, until there are as many vertices as before. Returns whether there are.
  bool restore_count() {
    constexpr int levels = 12, tries = 500;
    MoveParameters parameters = parameters_at(last_temperature);
    parameters.climb_share = 1;
    for (int level = 0; level < levels && surplus() != 0; ++level, parameters.count_cost *= 2) {
      context_.throw_if_cancelled();
      DislocationMoves moves = std::move(divide(1).front());
      for (int i = 0; i < tries && moves.surplus() != 0 && moves.irregular_count() > 0; ++i)
        moves.attempt_any(parameters);
      add(moves.counts);
    }
    return surplus() == 0;
  }

  /// Vertices that were added take the numbers of those that are gone.
  void write_back() {
    Mesh& mesh = result_mesh_;
    std::vector<std::uint32_t> number(mesh_.vertex_slots(), none);
    std::uint32_t hole = 0;
    const auto taken = [&](std::uint32_t v) {
      return mesh_.vertex_in_use(v) || std::binary_search(unused_.begin(), unused_.end(), v);
    };
    for (std::uint32_t v = 0; v < mesh_.vertex_slots(); ++v) {
      if (!mesh_.vertex_in_use(v)) continue;
      number[v] = v;
      if (v >= mesh.vertices.size()) {
        while (taken(hole)) ++hole;
        number[v] = hole++;
      }
      mesh.vertices[number[v]] = mesh_.position(v);
    }
    mesh.triangles.clear();
    for (std::uint32_t t = 0; t < mesh_.triangle_slots(); ++t) {
      if (!mesh_.triangle_in_use(t)) continue;
      const Triangle corners = mesh_.corners(t);
      mesh.triangles.push_back({number[corners[0]], number[corners[1]], number[corners[2]]});
    }
  }

  Mesh& result_mesh_;
  const DislocationOptions& options_;
  ExecutionContext& context_;
  const VertexConstraints& constraints_;
  EditableMesh mesh_;
  std::size_t count_;  ///< vertices in use at first
  PatchSurroundings common_;
  ReferencePoints points_;
  Random random_;
  std::vector<std::uint32_t> unused_;  ///< vertices that no triangle has used at first
  double edge_ = 0;                    ///< mean length
  DislocationResult result_;
};

}  // namespace

DislocationResult remove_dislocations(Mesh& mesh, const Projector* projector, const SizingField& sizing,
                                      const DislocationOptions& options, ExecutionContext& context,
                                      const VertexConstraints& constraints) {
  if (mesh.triangles.empty()) return {};
  return Annealing(mesh, projector, sizing, options, context, constraints).run();
}

}  // namespace evenmesh
