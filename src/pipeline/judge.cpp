#include "pipeline/judge.h"

#include <algorithm>
#include <memory>
#include <numeric>

#include "evenmesh/repair.h"
#include "evenmesh/solid.h"
#include "geometry/triangle.h"

namespace evenmesh {
namespace {

void append(std::vector<MeshPiece>& to, const std::vector<MeshPiece>& more) {
  to.insert(to.end(), more.begin(), more.end());
  std::stable_sort(to.begin(), to.end(), [](const MeshPiece& a, const MeshPiece& b) { return a.size > b.size; });
}

/// @param sheets_decide  a mesh with more sheets than closed parts stays as it is
Shape judged_mesh(const Shape& shape, bool sheets_decide, Judgement& judgement, ExecutionContext& context) {
  const Mesh& mesh = *shape.mesh();
  MeshParts parts = parts_of(
      mesh, shape.winding == Winding::any, [&](const Mesh& m) { return solidity(m, context); }, context);
  if (parts.as_given || parts.solid.triangles.empty()) return shape;
  if (sheets_decide && area_of(parts.sheets) > area_of(parts.solid)) return shape;
  judgement.turned_triangles += parts.turned_triangles;
  append(judgement.filled_holes, parts.filled_holes);
  append(judgement.turned_bodies, parts.turned_bodies);
  append(judgement.sheets, parts.sheet_pieces);
  Shape result = shape;
  if (shape.bounds == mesh.bounds()) result.bounds = parts.solid.bounds();
  result.what = std::make_shared<const Mesh>(std::move(parts.solid));
  return result;
}

Shape judged_any(const Shape& shape, bool sheets_decide, Judgement& judgement, ExecutionContext& context) {
  if (shape.mesh()) return judged_mesh(shape, sheets_decide, judgement, context);
  if (!shape.compound()) return shape;
  Compound compound = *shape.compound();
  for (Shape& operand : compound.operands) operand = judged_any(operand, false, judgement, context);
  Shape result = shape;
  result.what = std::make_shared<const Compound>(std::move(compound));
  return result;
}

}  // namespace

std::vector<Finding> Judgement::findings(double edge) const {
  std::vector<Finding> list;
  const auto number = [](std::size_t n) { return static_cast<double>(n); };
  const auto say = [&](FindingCode code, const std::vector<MeshPiece>& pieces, const char* one, const char* several,
                       const char* name) {
    if (pieces.empty()) return;
    const double area = std::accumulate(pieces.begin(), pieces.end(), 0.0,
                                        [](double sum, const MeshPiece& piece) { return sum + piece.area; });
    list.push_back(make_finding(code,
                                {{"count", number(pieces.size())},
                                 {name, std::string(pieces.size() == 1 ? one : several)},
                                 {"size", pieces[0].size},
                                 {"area", area}},
                                pieces[0].middle));
  };
  if (turned_triangles > 0)
    list.push_back(make_finding(FindingCode::triangles_turned, {{"count", number(turned_triangles)}}));
  say(FindingCode::holes_filled, filled_holes, "hole was", "holes were", "holes");
  say(FindingCode::parts_turned, turned_bodies, "part was", "parts were", "parts");
  const bool seen = !sheets.empty() && sheets[0].size >= edge;
  say(seen ? FindingCode::sheets_left_out : FindingCode::flakes_left_out, sheets, "sheet", "sheets", "sheets");
  return list;
}

Shape judged(const Shape& shape, const MeshOptions& options, Judgement& judgement, ExecutionContext& context) {
  const bool surface = options.wrap || options.method == Method::shell;
  if (surface && !shape.compound()) return shape;
  return judged_any(shape, options.method == Method::automatic, judgement, context);
}

}  // namespace evenmesh
