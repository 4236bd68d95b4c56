#pragma once
/// Shapes far from the origin of coordinates, as survey coordinates have them.
///
/// Kernels compute in single precision, which near (400,000, 800,000) steps by 0.06. So what lies far away compared
/// with its size is sampled about an origin of its own, and the mesh is moved back in double precision.

#include "evenmesh/shape.h"

namespace evenmesh {

/// An origin near the box along the axes on which it lies far away compared with its size, 0 along the others: a
/// multiple of a power of two about as large as the box, so that taking it away does not round.
Vec3 local_origin(const Box& box);

/// How far single precision moves points within the box, at most, model units.
double single_rounding(const Box& box);

/// The shape with its coordinates counted from the origin: where `shape` has p it has p − origin.
/// Cost: a copy of meshes and points.
Shape counted_from(const Vec3& origin, const Shape& shape);

/// How far points may lie from where a shape counted from `origin` takes them to be, since some of it is evaluated in
/// single precision far from its own origin; model units, 0 where nothing is. See shifted_field().
double rounding_of(const Shape& shape, const Vec3& origin);

}  // namespace evenmesh
