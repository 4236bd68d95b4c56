#pragma once
/// What a run has to say of its result: where it differs from what was given or asked for.

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "evenmesh/mesh.h"

namespace evenmesh {

enum class Severity {
  note,           ///< a choice that was left to the run
  warning,        ///< the result differs from what was given
  broken_promise  ///< a guarantee of mesh_shape() does not hold; the command line then exits with status 4
};

/// One for every kind of finding; finding_name() gives the name that files use.
enum class FindingCode {
  vertices_not_finite,
  polygons_not_simple,
  objects_left_out,
  line_skipped,
  unit_converted,
  fineness_estimated,
  resolution_limited,
  vertices_limited,
  closed_as_sheets,
  grid_refined,
  point_gaps_bridged,
  one_sided,
  triangles_turned,
  holes_filled,
  parts_turned,
  sheets_left_out,
  flakes_left_out,
  inside_by_vote,
  not_finite,
  single_precision,
  closed_by_bounds,
  crossings_unresolved,
  thin_parts_lost,
  parts_lost,
  cavities_filled,
  narrow_gaps_filled,
  sheets_merged,
  sheets_cut,
  wrap_distance,
  sheet_topology_kept,
  features_not_followed,
  short_features_left_out,
  features_released,
  small_components_dropped,
  gaps_filled,
  topology_simplified,
  euler_differs,
  vertex_count,
  cells_torn,
  not_manifold,
  not_closed,
  self_intersections,
  no_area,
  coarser_than_curvature,
  unit_lost,
  coordinates_rounded,
  stl_as_text
};

/// A number (lengths in model units) or a word.
using FindingValue = std::variant<double, std::string>;

struct Finding {
  FindingCode code{};
  Severity severity = Severity::warning;
  std::optional<Vec3> place;                                 ///< where, or where first
  std::vector<std::pair<std::string, FindingValue>> values;  ///< by name, in a fixed order
  std::string sentence;                                      ///< made from the rest; without a full stop
};

/// "vertex-count" and the like.
std::string_view finding_name(FindingCode code);

/// A finding with the severity and the sentence that belong to its code.
/// @param values  all that the code's sentence names
Finding make_finding(FindingCode code, std::vector<std::pair<std::string, FindingValue>> values = {},
                     std::optional<Vec3> place = {});

}  // namespace evenmesh
