#include "refine/polish.h"

#include "refine/vertex_rings.h"

namespace evenmesh {
namespace {

constexpr int max_rounds = 12;

std::vector<std::uint32_t> vertices_of_bad_triangles(const Mesh& mesh, const VertexRings& rings,
                                                     const VertexConstraints& constraints) {
  std::vector<char> bad(mesh.vertices.size(), 0);
  for (const Triangle& t : mesh.triangles)
    if (rings.score(t) < 1) bad[t[0]] = bad[t[1]] = bad[t[2]] = 1;
  std::vector<std::uint32_t> list;
  for (std::uint32_t v = 0; v < bad.size(); ++v)
    if (bad[v] && !rings.on_boundary(v) && !constraints.at_corner(v)) list.push_back(v);
  return list;
}

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
          !(fixed && constraints.chordal_deviation(mesh, v, rings.neighbours(v)) > chordal_deviation))
        best = worst, best_position = position;
    }
  }
  position = best_position;
  return best > before;
}

}  // namespace

std::size_t polish(Mesh& mesh, const Projector* projector, ExecutionContext& context,
                   const VertexConstraints& constraints) {
  const VertexRings rings(mesh);
  std::size_t moves = 0;
  for (int round = 0; round < max_rounds; ++round) {
    context.throw_if_cancelled();
    const std::size_t before = moves;
    for (const std::uint32_t v : vertices_of_bad_triangles(mesh, rings, constraints))
      moves += improve(mesh, rings, projector, constraints, v);
    if (moves == before) break;
  }
  return moves;
}

}  // namespace evenmesh
