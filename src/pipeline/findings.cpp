#include "evenmesh/findings.h"

#include <fmt/args.h>
#include <fmt/format.h>

#include <array>

namespace evenmesh {
namespace {

struct Kind {
  FindingCode code;
  Severity severity;
  std::string_view name;
  std::string_view sentence;  ///< with the names of values; x, y, z are those of the place
};

constexpr auto note = Severity::note, warning = Severity::warning, broken = Severity::broken_promise;

constexpr std::array kinds{
    Kind{FindingCode::fineness_estimated, note, "fineness-estimated",
         "no -n or -l given: {vertices:.0f} vertices, from area {area:.4g}{also}"},
    Kind{FindingCode::resolution_limited, warning, "resolution-limited",
         "the grid ends at {resolution:.0f} cells along the longest side: fewer than {alpha:.0f} samples per seed"},
    Kind{FindingCode::vertices_limited, warning, "vertices-limited",
         "{asked:.0f} vertices would have fewer than {alpha:.0f} samples each at resolution {resolution:.0f}; meshing "
         "with {vertices:.0f}"},
    Kind{FindingCode::closed_as_sheets, broken, "closed-as-sheets",
         "the input is closed, but its walls are only {thickness:.2g} thick on average: about {vertices:.0f} vertices "
         "are needed (-n {vertices:.0f}), or -r {resolution:.0f}, to keep their two sides apart; meshed as an open "
         "surface"},
    Kind{
        FindingCode::grid_refined, note, "grid-refined",
        "thin parts of about {thickness:.2g}, {area:.3g} in area, are kept with a grid of {resolution:.0f} cells along "
        "the longest side instead of {planned:.0f}"},
    Kind{FindingCode::point_gaps_bridged, note, "point-gaps-bridged",
         "points about {spacing:.3g} apart: gaps of up to {gap:.3g} ({voxels:.0f} voxels) are bridged"},
    Kind{FindingCode::inside_by_vote, warning, "inside-by-vote",
         "the input is not closed: inside or outside was settled by vote at {count:.0f} grid points"},
    Kind{FindingCode::not_finite, warning, "not-finite",
         "{name}: not a finite number at {count:.0f} points, which were taken as outside"},
    Kind{FindingCode::closed_by_bounds, warning, "closed-by-bounds", "the solid leaves its bounds and is closed there"},
    Kind{FindingCode::crossings_unresolved, warning, "crossings-unresolved",
         "parts thinner than a grid cell ({spacing:.3g}) were lost: {count:.0f} of {all:.0f} crossings were left out; "
         "-r {finer:.0f} resolves twice as much"},
    Kind{FindingCode::thin_parts_lost, broken, "thin-parts-lost",
         "thin {what} between grid points {spacing:.3g} apart: {area:.3g} of area about {thickness:.2g} thick (a tenth "
         "below {least:.2g}) in {parts:.0f} places, the largest around ({x:.4g}, {y:.4g}, {z:.4g}), {dx:.3g} × "
         "{dy:.3g} × {dz:.3g} in size: {cure}"},
    Kind{FindingCode::parts_lost, broken, "parts-lost",
         "{area:.3g} of the input's area lies farther than an edge from the mesh, in {parts:.0f} places, the largest "
         "around ({x:.4g}, {y:.4g}, {z:.4g}), {dx:.3g} × {dy:.3g} × {dz:.3g} in size: {cure}"},
    Kind{FindingCode::sheets_merged, warning, "sheets-merged",
         "sheets that come within {width:.3g} of each other merge in {count:.0f} places, first at ({x:.4g}, {y:.4g}, "
         "{z:.4g}): {cure}"},
    Kind{FindingCode::sheets_cut, warning, "sheets-cut",
         "{count:.0f} sheets of surface end where others meet or cross them"},
    Kind{FindingCode::wrap_distance, note, "wrap-distance",
         "the wrap lies about {distance:.3g} outside of the surface, and closes what is narrower than {gap:.3g}"},
    Kind{FindingCode::sheet_topology_kept, warning, "sheet-topology-kept",
         "sheets have no inside that balls could be added to: their topology was kept"},
    Kind{FindingCode::features_not_followed, warning, "features-not-followed",
         "none of the {count:.0f} sharp edges found is kept: {reason}"},
    Kind{FindingCode::features_released, warning, "features-released",
         "{count:.0f} sharp edges were given up where they stood in the way of the topology: ask for more vertices, or "
         "take --topology keep"},
    Kind{FindingCode::small_components_dropped, warning, "small-components-dropped",
         "{count:.0f} pieces of surface smaller than a cell were left out"},
    Kind{FindingCode::balls_united, warning, "balls-united",
         "the surface comes closer to itself than the grid can tell, or ends in detail that it cannot: {count:.0f} "
         "balls of half an edge or more were united with the solid there"},
    Kind{FindingCode::topology_simplified, warning, "topology-simplified",
         "the topology was made simpler where it needs more vertices: {count:.0f} balls of half an edge or more were "
         "united with the solid there"},
    Kind{FindingCode::euler_differs, warning, "euler-differs",
         "the mesh has Euler number {mesh:.0f}, the sampled surface {surface:.0f}: ask for more vertices"},
    Kind{FindingCode::vertex_count, note, "vertex-count",
         "{vertices:.0f} vertices instead of {asked:.0f}: the topology {reason}"},
    Kind{FindingCode::cells_torn, broken, "cells-torn",
         "the cells do not fit together everywhere: the mesh has cuts or holes there; ask for more vertices"},
    Kind{FindingCode::not_manifold, broken, "not-manifold",
         "the mesh is not a two-manifold: {edges:.0f} non-manifold edges; ask for more vertices"},
    Kind{FindingCode::not_closed, broken, "not-closed",
         "the mesh is not a closed two-manifold: {boundary:.0f} boundary and {edges:.0f} non-manifold edges; ask for "
         "more vertices"},
    Kind{FindingCode::self_intersections, broken, "self-intersections",
         "{count:.0f} pairs of triangles intersect each other; ask for more vertices"},
    Kind{FindingCode::no_area, broken, "no-area", "{count:.0f} triangles have no area; ask for more vertices"},
};

const Kind& kind_of(FindingCode code) {
  return kinds[static_cast<std::size_t>(code)];
}

constexpr bool in_order() {
  for (std::size_t i = 0; i < kinds.size(); ++i)
    if (static_cast<std::size_t>(kinds[i].code) != i) return false;
  return true;
}
static_assert(in_order() && kinds.size() == static_cast<std::size_t>(FindingCode::no_area) + 1);

std::string sentence_of(const Finding& finding, std::string_view pattern) {
  fmt::dynamic_format_arg_store<fmt::format_context> arguments;
  for (const auto& [name, value] : finding.values)
    std::visit([&, &key = name](const auto& v) { arguments.push_back(fmt::arg(key.c_str(), v)); }, value);
  if (finding.place) {
    arguments.push_back(fmt::arg("x", finding.place->x));
    arguments.push_back(fmt::arg("y", finding.place->y));
    arguments.push_back(fmt::arg("z", finding.place->z));
  }
  return fmt::vformat(pattern, arguments);
}

}  // namespace

std::string_view finding_name(FindingCode code) {
  return kind_of(code).name;
}

Finding make_finding(FindingCode code, std::vector<std::pair<std::string, FindingValue>> values,
                     std::optional<Vec3> place) {
  const Kind& kind = kind_of(code);
  Finding finding{code, kind.severity, place, std::move(values), {}};
  finding.sentence = sentence_of(finding, kind.sentence);
  return finding;
}

}  // namespace evenmesh
