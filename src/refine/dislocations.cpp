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
#include "refine/reference_points.h"

namespace evenmesh {
namespace {

constexpr std::uint32_t none = EditableMesh::none;
constexpr std::size_t vertices_per_part = 400;

class Annealing {
 public:
  Annealing(Mesh& mesh, const Projector* projector, const SizingField& sizing, const DislocationOptions& options,
            ExecutionContext& context, const VertexConstraints& constraints)
      : result_mesh_(mesh),
        options_(options),
        context_(context),
        constraints_(constraints),
        count_(mesh.vertices.size()),
        mesh_(mesh, 64 + mesh.vertices.size() / 20, context),
        common_{mesh_, projector, sizing, {options.size_weight}},
        points_(mesh_, projector, context),
        random_(options.seed) {
    const double area = area_of(mesh);
    double squares = 0;
    if (sizing.uniform()) {
      squares = static_cast<double>(mesh.triangles.size());
    } else {
      for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto [a, b, c] = corners_of(mesh, t);
        const double edge = sizing.edge((1.0 / 3) * (a + b + c));
        squares += edge * edge;
      }
    }
    common_.twice_target = 2 * area / squares;
    edge_ = std::sqrt(area / static_cast<double>(mesh.triangles.size()) * 4 / std::numbers::sqrt3);
    common_.part.assign(mesh_.vertex_slots(), none);
    common_.held.assign(mesh_.vertex_slots(), 0);
    for (std::uint32_t v = 0; v < mesh_.vertex_slots(); ++v)
      common_.held[v] = mesh_.vertex_in_use(v) && (mesh_.on_boundary(v) || constraints.vertex(v));
    common_.find_energies();
  }

  DislocationResult run() {
    result_.irregular_before = irregular_vertices().size();
    for (int round = 0; round < options_.rounds; ++round) {
      context_.throw_if_cancelled();
      const double progress = options_.rounds > 1 ? static_cast<double>(round) / (options_.rounds - 1) : 1;
      anneal(options_.temperature * std::pow(options_.last_temperature / options_.temperature, progress));
    }
    if (restore_count()) write_back();
    result_.irregular = irregular_vertices().size();
    return result_;
  }

 private:
  std::vector<std::uint32_t> irregular_vertices() const {
    std::vector<std::uint32_t> list;
    for (std::uint32_t v = 0; v < mesh_.vertex_slots(); ++v)
      if (mesh_.vertex_in_use(v) && !mesh_.on_boundary(v) && mesh_.valence(v) != 6) list.push_back(v);
    return list;
  }
  std::size_t vertices_in_use() const {
    std::size_t n = 0;
    for (std::uint32_t v = 0; v < mesh_.vertex_slots(); ++v) n += mesh_.vertex_in_use(v);
    return n;
  }

  /// Parts of the mesh, grown from random vertices; vertices that touch another part belong to none.
  std::size_t divide(std::size_t parts) {
    std::vector<std::uint32_t> queue, used, all(mesh_.vertex_slots(), none);
    for (std::uint32_t v = 0; v < mesh_.vertex_slots(); ++v)
      if (mesh_.vertex_in_use(v)) used.push_back(v);
    for (std::uint32_t p = 0; p < parts; ++p) {
      const std::uint32_t v = used[random_.below(used.size())];
      if (all[v] == none) queue.push_back(v);
      all[v] = std::min(all[v], p);
    }
    std::vector<std::uint32_t> list;
    const auto neighbours = [&](std::uint32_t v) {
      list.clear();
      if (!mesh_.on_boundary(v)) mesh_.around(v, [&](std::uint32_t h) { list.push_back(mesh_.target(h)); });
      return std::span<const std::uint32_t>(list);
    };
    for (std::size_t at = 0; at < queue.size(); ++at)
      for (const std::uint32_t w : neighbours(queue[at]))
        if (all[w] == none) {
          all[w] = all[queue[at]];
          queue.push_back(w);
        }
    common_.part.assign(mesh_.vertex_slots(), none);
    for (const std::uint32_t v : used) {
      bool inside = all[v] != none && !mesh_.on_boundary(v);
      for (const std::uint32_t w : neighbours(v)) inside = inside && all[w] == all[v];
      if (inside) common_.part[v] = all[v];
    }
    common_.vertex_mark.assign(mesh_.vertex_slots(), 0);
    common_.triangle_mark.assign(mesh_.triangle_slots(), 0);
    return parts;
  }

  /// What is not in use, shared out among the parts.
  std::vector<EditableMesh::FreeSlots> free_slots(std::size_t parts) const {
    std::vector<EditableMesh::FreeSlots> slots(parts);
    std::size_t vertices = 0, triangles = 0;
    for (std::uint32_t v = 0; v < mesh_.vertex_slots(); ++v)
      if (!mesh_.vertex_in_use(v)) slots[vertices++ % parts].vertices.push_back(v);
    for (std::uint32_t t = 0; t < mesh_.triangle_slots(); ++t)
      if (!mesh_.triangle_in_use(t)) slots[triangles++ / 2 % parts].triangles.push_back(t);
    return slots;
  }
  MoveParameters parameters_at(double temperature) const {
    MoveParameters parameters;
    parameters.irregular_cost = options_.irregular_cost;
    parameters.temperature = temperature;
    parameters.tolerance = options_.tolerance * edge_;
    parameters.longest_chain = options_.longest_chain;
    parameters.climb_share = options_.climb_share;
    parameters.count_cost = options_.count_cost;
    return parameters;
  }
  int surplus() const { return static_cast<int>(vertices_in_use()) - static_cast<int>(count_); }

  void anneal(double temperature) {
    const std::size_t parts = divide(std::max<std::size_t>(1, vertices_in_use() / vertices_per_part));
    std::vector<EditableMesh::FreeSlots> slots = free_slots(parts);
    std::vector<std::vector<std::uint32_t>> irregular(parts);
    for (const std::uint32_t v : irregular_vertices())
      if (common_.part[v] != none) irregular[common_.part[v]].push_back(v);
    const MoveParameters parameters = parameters_at(temperature);
    const int all = surplus(), n = static_cast<int>(parts);
    std::vector<DislocationMoves> moves;
    for (std::uint32_t p = 0; p < parts; ++p) {
      moves.emplace_back(common_, points_, constraints_, p, std::move(slots[p]), random_.bits());
      moves.back().surplus = all * static_cast<int>(p + 1) / n - all * static_cast<int>(p) / n;
    }
    parallel_tasks(context_, parts, [&](std::size_t p) {
      const std::size_t tries = irregular[p].size() * options_.work / static_cast<std::size_t>(options_.rounds);
      for (std::size_t i = 0; i < tries && !irregular[p].empty(); ++i) moves[p].attempt_any(irregular[p], parameters);
    });
    for (const DislocationMoves& m : moves) add(m.counts);
  }
  void add(const MoveCounts& c) {
    result_.attempts += c.attempts;
    result_.relaxed += c.relaxed;
    result_.finished += c.finished;
    result_.bent += c.bent;
    result_.accepted += c.accepted;
  }

  /// Splits or collapses, ever dearer ones, until there are as many vertices as before. Returns whether there are.
  bool restore_count() {
    if (surplus() == 0) return true;
    divide(1);
    DislocationMoves moves(common_, points_, constraints_, 0, std::move(free_slots(1)[0]), random_.bits());
    moves.surplus = surplus();
    std::vector<std::uint32_t> irregular = irregular_vertices();
    std::erase_if(irregular, [&](std::uint32_t v) { return common_.part[v] == none; });
    MoveParameters parameters = parameters_at(options_.last_temperature);
    parameters.climb_share = 1;
    for (int level = 0; level < 12 && moves.surplus != 0; ++level, parameters.count_cost *= 2)
      for (int i = 0; i < 500 && moves.surplus != 0 && !irregular.empty(); ++i)
        moves.attempt_any(irregular, parameters);
    add(moves.counts);
    return moves.surplus == 0;
  }

  void write_back() {
    Mesh& mesh = result_mesh_;
    std::vector<std::uint32_t> number(mesh_.vertex_slots(), none);
    std::uint32_t hole = 0;
    for (std::uint32_t v = 0; v < mesh_.vertex_slots(); ++v) {
      if (!mesh_.vertex_in_use(v)) continue;
      number[v] = v;
      if (v >= count_) {
        while (hole < count_ && mesh_.vertex_in_use(hole)) ++hole;
        number[v] = hole++;
      }
      mesh.vertices[number[v]] = mesh_.position(v);
    }
    mesh.triangles.clear();
    for (std::uint32_t t = 0; t < mesh_.triangle_slots(); ++t)
      if (mesh_.triangle_in_use(t))
        mesh.triangles.push_back(
            {number[mesh_.origin(3 * t)], number[mesh_.origin(3 * t + 1)], number[mesh_.origin(3 * t + 2)]});
  }

  Mesh& result_mesh_;
  const DislocationOptions& options_;
  ExecutionContext& context_;
  const VertexConstraints& constraints_;
  std::size_t count_;  ///< vertices asked for
  EditableMesh mesh_;
  PatchSurroundings common_;
  ReferencePoints points_;
  Random random_;
  double edge_ = 0;
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
