#include "refine/polish.h"

#include <algorithm>

#include "core/parallel.h"
#include "refine/vertex_rings.h"

namespace evenmesh {
namespace {

constexpr int max_rounds = 12;

bool improve(Mesh& mesh, const VertexRings& rings, const Projector* projector, const VertexConstraints& constraints,
             std::uint32_t v) {
  Vec3& position = mesh.vertices[v];
  std::vector<Vec3> normals;
  rings.normals(v, normals);
  const TangentPlane plane(rings.normal(v));
  const double edge = rings.edge_length(v), before = rings.worst_score(v, normals);
  const bool fixed = constraints.vertex(v);
  const double chordal_deviation =
      fixed ? std::max(constraints.max_chordal_deviation, constraints.chordal_deviation(mesh, v, rings.neighbours(v)))
            : 0;
  Vec3 best_position = position;
  double best = before;
  for (const double step : {0.2, 0.1, 0.05, 0.02, 0.01}) {
    if (best >= 1) break;
    const Vec3 from = best_position;
    for (int eighth = 0; eighth < 8; ++eighth) {
      const Vec3 trial = from + plane.step(eighth, step * edge);
      position = fixed ? constraints.slide(v, trial) : projector ? projector->project(trial, 0.3 * edge) : trial;
      const double worst = rings.worst_score(v, normals, best);
      if (worst > best + 1e-6 &&
          !(fixed && constraints.chordal_deviation(mesh, v, rings.neighbours(v)) > chordal_deviation)) {
        best = worst;
        best_position = position;
      }
    }
  }
  position = best_position;
  return best > before;
}

/// Rounds over the vertices of bad triangles, in the order of their numbers. What an attempt does depends on the
/// vertex' neighbours alone: a vertex waits for its neighbours of lower number and for nobody else, and where neither
/// it nor a neighbour has moved since an attempt in vain, there is no need for another.
class Polisher {
 public:
  Polisher(Mesh& mesh, const Projector* projector, ExecutionContext& context, const VertexConstraints& constraints)
      : mesh_(mesh),
        projector_(projector),
        context_(context),
        constraints_(constraints),
        rings_(mesh, context),
        bad_(mesh.triangles.size(), 0),
        hopeless_(mesh.vertices.size(), 0),
        wave_(mesh.vertices.size(), 0) {
    for (const std::uint32_t t : triangles_below(mesh, 1, context)) bad_[t] = 1;
  }

  std::size_t run() {
    std::size_t moves = 0;
    for (int round = 0; round < max_rounds; ++round) {
      context_.throw_if_cancelled();
      const std::size_t before = moves;
      for (std::vector<std::uint32_t>& wave : waves_of(vertices_of_bad_triangles())) moves += improve_all(wave);
      if (moves == before) break;
    }
    return moves;
  }

 private:
  std::vector<std::uint32_t> vertices_of_bad_triangles() const {
    std::vector<std::uint32_t> list;
    for (std::size_t t = 0; t < bad_.size(); ++t)
      if (bad_[t]) list.insert(list.end(), mesh_.triangles[t].begin(), mesh_.triangles[t].end());
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    std::erase_if(list, [&](std::uint32_t v) { return rings_.on_boundary(v) || constraints_.at_corner(v); });
    return list;
  }

  /// Each vertex comes in a later wave than those of its neighbours that have lower numbers.
  std::vector<std::vector<std::uint32_t>> waves_of(const std::vector<std::uint32_t>& list) {
    std::vector<std::vector<std::uint32_t>> waves;
    for (const std::uint32_t v : list) {
      std::uint32_t after = 0;
      for (const std::uint32_t w : rings_.neighbours(v))
        if (w < v) after = std::max(after, wave_[w]);
      wave_[v] = after + 1;
      if (waves.size() == after) waves.emplace_back();
      waves[after].push_back(v);
    }
    for (const std::uint32_t v : list) wave_[v] = 0;
    return waves;
  }

  /// Of vertices no two of which are neighbours. Returns how many moved.
  std::size_t improve_all(std::vector<std::uint32_t>& wave) {
    std::erase_if(wave, [&](std::uint32_t v) { return hopeless_[v]; });
    std::vector<char> moved(wave.size(), 0);
    parallel_tasks(context_, wave.size(), [&](std::size_t i) {
      moved[i] = improve(mesh_, rings_, projector_, constraints_, wave[i]);
      if (moved[i])
        for (const std::uint32_t t : rings_.triangles(wave[i])) bad_[t] = rings_.score(mesh_.triangles[t]) < 1;
    });
    for (std::size_t i = 0; i < wave.size(); ++i) {
      hopeless_[wave[i]] = !moved[i];
      if (moved[i])
        for (const std::uint32_t w : rings_.neighbours(wave[i])) hopeless_[w] = 0;
    }
    return static_cast<std::size_t>(std::count(moved.begin(), moved.end(), 1));
  }

  Mesh& mesh_;
  const Projector* projector_;
  ExecutionContext& context_;
  const VertexConstraints& constraints_;
  const VertexRings rings_;
  std::vector<char> bad_;            ///< by triangle
  std::vector<char> hopeless_;       ///< by vertex: an attempt was in vain, and nothing has moved since
  std::vector<std::uint32_t> wave_;  ///< by vertex, while waves are made
};

}  // namespace

std::size_t polish(Mesh& mesh, const Projector* projector, ExecutionContext& context,
                   const VertexConstraints& constraints) {
  return Polisher(mesh, projector, context, constraints).run();
}

}  // namespace evenmesh
