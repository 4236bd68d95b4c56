#include "evenmesh/findings.h"

#include <fmt/args.h>
#include <fmt/format.h>

#include <array>
#include <cmath>

namespace evenmesh {

/// A coordinate in sentences: as they ask for it or, where that would not tell places apart, with nine digits.
struct Coordinate {
  double value;
};

}  // namespace evenmesh

template <>
struct fmt::formatter<evenmesh::Coordinate> : fmt::formatter<double> {
  auto format(const evenmesh::Coordinate& c, fmt::format_context& context) const {
    constexpr double large = 1e4;
    if (std::abs(c.value) < large) return fmt::formatter<double>::format(c.value, context);
    return fmt::format_to(context.out(), "{:.9g}", c.value);
  }
};

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
    Kind{FindingCode::vertices_not_finite, warning, "vertices-not-finite",
         "{name}: {count:.0f} {what} whose coordinates are not finite numbers {were} left out{also}"},
    Kind{FindingCode::polygons_not_simple, warning, "polygons-not-simple",
         "{name}: {count:.0f} of its polygons cross themselves or have too many corners, first at ({x:.4g}, {y:.4g}, "
         "{z:.4g}): their triangles go out from their first corner and may cover something else; cut them into simple "
         "polygons"},
    Kind{FindingCode::objects_left_out, warning, "objects-left-out",
         "{name}: {count:.0f} {what} of type '{type}' {were} left out; make {them} of type 'model' to keep {them}"},
    Kind{FindingCode::line_skipped, note, "line-skipped",
         "{name}: line {line:.0f}, {text}, holds titles, not a point, and was skipped"},
    Kind{FindingCode::unit_converted, note, "unit-converted",
         "{name}: lengths are converted from {from} to {to} (times {factor:.6g})"},
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
    Kind{
        FindingCode::one_sided, warning, "one-sided",
        "{count:.0f} triangles of the input form a surface with one side only, as a Klein bottle or a Möbius strip: it "
        "has no inside, and no mesh can face one way on it, so {what}"},
    Kind{FindingCode::triangles_turned, note, "triangles-turned",
         "{count:.0f} triangles that faced other ways than those around them were turned"},
    Kind{FindingCode::holes_filled, warning, "holes-filled",
         "the input is not closed: {count:.0f} {holes} filled, the largest {size:.4g} across at ({x:.4g}, {y:.4g}, "
         "{z:.4g}); --method shell keeps them open"},
    Kind{FindingCode::parts_turned, warning, "parts-turned",
         "{count:.0f} closed {parts} inside out beside others and turned, the largest {size:.4g} across at ({x:.4g}, "
         "{y:.4g}, {z:.4g}); 'repair --hull oriented' lets such parts take away instead"},
    Kind{FindingCode::sheets_left_out, broken, "sheets-left-out",
         "{count:.0f} {sheets} of no thickness beside the solid, of area {area:.4g}: left out, the largest {size:.4g} "
         "across at ({x:.4g}, {y:.4g}, {z:.4g}); --method shell keeps it"},
    Kind{FindingCode::flakes_left_out, warning, "flakes-left-out",
         "{count:.0f} loose triangles or sheets smaller than an edge of the mesh were left out, the largest {size:.4g} "
         "across at ({x:.4g}, {y:.4g}, {z:.4g})"},
    Kind{FindingCode::inside_by_vote, warning, "inside-by-vote",
         "the input is not closed: inside or outside was settled by vote at {count:.0f} grid points"},
    Kind{FindingCode::not_finite, warning, "not-finite",
         "{name}: not a finite number at {count:.0f} points, which were taken as outside"},
    Kind{FindingCode::single_precision, warning, "single-precision",
         "{name} is computed in single precision, which tells points that far from the origin apart to {rounding:.2g} "
         "({edges:.2g} edges) only: move it to the origin"},
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
    Kind{FindingCode::cavities_filled, note, "cavities-filled",
         "{count:.0f} {surfaces} within the solid, not reached from outside: filled; --hull all keeps {them}"},
    Kind{FindingCode::narrow_gaps_filled, warning, "narrow-gaps-filled",
         "gaps narrower than {gap:.3g}, where edges are longer, were filled with the surface in them, of area "
         "{area:.4g}: ask for more vertices{cure}"},
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
         "{count:.0f} of {all:.0f} sharp edges are not held, first near ({x:.4g}, {y:.4g}, {z:.4g}): {reason}"},
    Kind{FindingCode::short_features_left_out, warning, "short-features-left-out",
         "{count:.0f} sharp edges shorter than {length:.3g} are not kept: they would take more than a fifth of the "
         "vertices; ask for more"},
    Kind{FindingCode::features_released, warning, "features-released",
         "{count:.0f} sharp edges were given up where they stood in the way of the topology: ask for more vertices"},
    Kind{FindingCode::small_components_dropped, warning, "small-components-dropped",
         "{count:.0f} pieces of surface smaller than a cell were left out"},
    Kind{FindingCode::gaps_filled, warning, "gaps-filled",
         "the surface comes closer to itself than the grid can tell (about {size:.3g}), or is thinner: that was filled "
         "in {count:.0f} places, a volume of {volume:.3g} altogether, first at ({x:.4g}, {y:.4g}, {z:.4g}); -n "
         "{finer:.0f} tells twice as much"},
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
         "{count:.0f} pairs of triangles intersect each other{where}; ask for more vertices"},
    Kind{FindingCode::no_area, broken, "no-area", "{count:.0f} triangles have no area{where}; ask for more vertices"},
    Kind{FindingCode::coarser_than_curvature, warning, "coarser-than-curvature",
         "{percent:.0f} % of the edges are longer than the radius of curvature there, so that finer detail is lost: "
         "about "
         "{vertices:.0f} vertices would show it"},
    Kind{FindingCode::unit_lost, warning, "unit-lost",
         "{format} files have no place for a unit: the coordinates stay in {unit}, which their reader has to know; "
         "--unit {usual} converts them"},
    Kind{FindingCode::coordinates_rounded, warning, "coordinates-rounded",
         "single precision, all that the file's format has, moves vertices by up to {edges:.2g} edges; the figures are "
         "those of the file: write PLY, OBJ, OFF, STL or 3MF"},
    Kind{FindingCode::stl_as_text, note, "stl-as-text",
         "binary STL would move vertices by up to {edges:.2g} edges: the STL file is text"},
};

const Kind& kind_of(FindingCode code) {
  return kinds[static_cast<std::size_t>(code)];
}

constexpr bool in_order() {
  for (std::size_t i = 0; i < kinds.size(); ++i)
    if (static_cast<std::size_t>(kinds[i].code) != i) return false;
  return true;
}
static_assert(in_order() && kinds.size() == static_cast<std::size_t>(FindingCode::stl_as_text) + 1);

std::string sentence_of(const Finding& finding, std::string_view pattern) {
  fmt::dynamic_format_arg_store<fmt::format_context> arguments;
  for (const auto& [name, value] : finding.values)
    std::visit([&, &key = name](const auto& v) { arguments.push_back(fmt::arg(key.c_str(), v)); }, value);
  if (finding.place) {
    arguments.push_back(fmt::arg("x", Coordinate{finding.place->x}));
    arguments.push_back(fmt::arg("y", Coordinate{finding.place->y}));
    arguments.push_back(fmt::arg("z", Coordinate{finding.place->z}));
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
