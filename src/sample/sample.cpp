#include "sample/sample.h"

#include <algorithm>
#include <cmath>

#include "evenmesh/error.h"
#include "evenmesh/solid.h"
#include "grid/combine.h"
#include "sample/distance_field.h"
#include "sample/field_parts.h"
#include "sample/scan.h"
#include "shape/ray_source.h"

namespace evenmesh {
namespace {

/// The grid less its outermost layers: what is cut there shows in no result, since compounds leave room around theirs.
Box room_of(const Grid& grid) {
  return {grid.point(0.5, 0.5, 0.5), grid.point(grid.size[0] - 1.5, grid.size[1] - 1.5, grid.size[2] - 1.5)};
}

SampleSet sample_any(const Shape& shape, const Grid& grid, const Box& bounds, ExecutionContext& context);

/// An operand may reach beyond the grid, or be unbounded.
SampleSet sample_operand(const Shape& operand, const Grid& grid, ExecutionContext& context) {
  const Box room = room_of(grid);
  const Box bounds = operand.bounds.empty() ? room : common(operand.bounds, room);
  SampleSet none;
  none.grid = grid;
  if (bounds.empty()) return none;
  SampleSet samples = sample_any(operand, grid, bounds, context);
  if (!operand.capped_by_bounds) samples.cut_by_bounds = false;
  return samples;
}

SampleSet sample_boolean(const Compound& compound, const Grid& grid, ExecutionContext& context) {
  const Boolean operation = compound.kind == Compound::Kind::unite       ? Boolean::unite
                            : compound.kind == Compound::Kind::intersect ? Boolean::intersect
                                                                         : Boolean::subtract;
  SampleSet result = sample_operand(compound.operands[0], grid, context);
  for (std::size_t i = 1; i < compound.operands.size(); ++i)
    result = combine(result, sample_operand(compound.operands[i], grid, context), operation, context);
  return result;
}

SampleSet sample_offset(const Compound& compound, const Grid& grid, const Box& bounds, ExecutionContext& context) {
  const Shape& operand = compound.operands[0];
  Box reach = bounds;
  for (int i = 0; i < 3; ++i) {
    reach.lo[i] -= std::abs(compound.distance);
    reach.hi[i] += std::abs(compound.distance);
  }
  const Box box = operand.bounds.empty() ? reach : common(operand.bounds, reach);
  SampleSet none;
  none.grid = grid;
  if (box.empty() || !(box.longest_side() > 0)) return none;
  // Far away from it the surface may be coarser.
  const double spacing = grid.spacing * std::clamp(std::abs(compound.distance) / (12 * grid.spacing), 1.0, 2.0);
  const auto cells = static_cast<std::size_t>(std::ceil(box.longest_side() / spacing));
  const Grid own = make_grid(box, std::clamp<std::size_t>(cells, 1, 8192));
  const SampleSet samples = sample_any(operand, own, box, context);
  if (samples.size() == 0) return none;
  SampleSet set = sample_field(*distance_field(samples, compound.distance, grid.spacing, room_of(grid), context), grid,
                               bounds, context);
  set.thin = samples.thin;
  return set;
}

SampleSet sample_any(const Shape& shape, const Grid& grid, const Box& bounds, ExecutionContext& context) {
  if (const Field* field = shape.field()) return sample_field(*field, grid, bounds, context);
  if (const Compound* compound = shape.compound())
    return compound->kind == Compound::Kind::offset ? sample_offset(*compound, grid, bounds, context)
                                                    : sample_boolean(*compound, grid, context);
  if (const RaySource* sampler = shape.ray_source()) return sampler->sample(grid, bounds, context);
  if (!shape.mesh()) throw InvalidInput(shape.name + " has no inside: give the shape a mesh or a field");
  return sample_dexels(scan_mesh(*shape.mesh(), grid, context, bounds, shape.winding), *shape.mesh(), context);
}

}  // namespace

SampleSet sample_shape(const Shape& shape, const Grid& grid, ExecutionContext& context) {
  SampleSet set = with_threads(context, [&] { return sample_any(shape, grid, shape.bounds, context); });
  if (set.size() == 0 && shape.compound())
    throw UnusableInput("nothing is left of the solid: the result of " + shape.name + " is empty");
  if (set.size() == 0)
    throw UnusableInput(shape.name + " has no surface within its bounds: raise the resolution or check the bounds");
  return set;
}

}  // namespace evenmesh
