#include <fmt/format.h>

#include <cmath>

#include "evenmesh/error.h"
#include "evenmesh/repair.h"
#include "evenmesh/solid.h"
#include "geometry/sidedness.h"
#include "pipeline/sampler.h"

namespace evenmesh {
namespace {

/// Below that, rays find nothing either.
constexpr double hardly_any_inside = 0.3;

[[noreturn]] void refuse_sheet(const Shape& sheet, const Compound& around, double solidity) {
  const double reach = std::abs(around.distance);
  const double resolution = reach > 0 ? std::round(sheet.bounds.longest_side() / reach) : 0;
  const bool sensible = resolution >= 8 && resolution <= 8192;
  const std::string what = around.kind == Compound::Kind::offset ? "grown or shrunk" : "combined with others";
  const std::string how = sensible ? fmt::format("a solid about {:.3g} thick around it: evenmesh wrap {} -r {:.0f}",
                                                 2 * reach, sheet.name, resolution)
                                   : fmt::format("a thick solid around it: evenmesh wrap {}", sheet.name);
  const char* otherwise =
      solidity < hardly_any_inside ? "" : ", or let --method raster take for inside what most rays do";
  throw UnusableInput(fmt::format("{} is an open sheet and has no inside that could be {}; make {} -o solid.ply{}",
                                  sheet.name, what, how, otherwise));
}

void require_inside(const Shape& shape, const Compound& around, ExecutionContext& context) {
  if (const Compound* compound = shape.compound()) {
    for (const Shape& operand : compound->operands)
      require_inside(operand, compound->kind == Compound::Kind::offset ? *compound : around, context);
  } else if (const Mesh* mesh = shape.mesh()) {
    const double inside = is_closed(*mesh) ? 1 : solidity(*mesh, context);
    if (inside < min_solidity) refuse_sheet(shape, around, inside);
  }
}

}  // namespace

void require_insides(const Shape& shape, ExecutionContext& context) {
  if (const Compound* compound = shape.compound()) require_inside(shape, *compound, context);
}

}  // namespace evenmesh
