#pragma once
/// Solids made of other solids: booleans, offsets, motions. They are shapes like any other: nothing is computed before
/// they are sampled, then all parts are sampled on one grid.

#include <array>
#include <string>
#include <vector>

#include "evenmesh/shape.h"

namespace evenmesh {

/// x ↦ columns · x + translation.
struct Affine {
  std::array<Vec3, 3> column{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  Vec3 translation{};

  Vec3 operator()(const Vec3& p) const { return p.x * column[0] + p.y * column[1] + p.z * column[2] + translation; }
  /// The linear part alone.
  Vec3 direction(const Vec3& v) const { return v.x * column[0] + v.y * column[1] + v.z * column[2]; }
  double determinant() const { return dot(column[0], cross(column[1], column[2])); }
  /// @throws InvalidInput  the determinant is 0 or not finite
  Affine inverse() const;
  /// First `first`, then this.
  Affine after(const Affine& first) const;

  static Affine translate(const Vec3& by) { return {.translation = by}; }
  static Affine scale(const Vec3& by) { return {.column = {Vec3{by.x, 0, 0}, Vec3{0, by.y, 0}, Vec3{0, 0, by.z}}}; }
  /// Counter-clockwise seen from the tip of the axis. @throws InvalidInput  the axis is zero or not finite
  static Affine rotate(const Vec3& axis, double degrees);
};

/// What is made of operands.
struct Compound {
  enum class Kind { unite, intersect, subtract, offset };
  Kind kind = Kind::unite;
  std::vector<Shape> operands;  ///< of subtract: from the first all others; of offset: one
  double distance = 0;          ///< of offset, model units
};

/// Points of any, of all, of the first and none of the others. One operand is returned as it is.
///
/// Operands are triangle meshes (inside by winding number), fields, compounds. Fields without bounds may be unbounded
/// where they only take away or limit: operands of intersect (not all), and what is subtracted.
/// Guarantee: exact on the samples; the result is a closed solid. Meeting faces are one face: A ∪ B of two boxes that
/// touch is one box.
/// @throws InvalidInput  no operand, or a point cloud
Shape unite(std::vector<Shape> shapes);
Shape intersect(std::vector<Shape> shapes);
Shape subtract(Shape from, std::vector<Shape> what);

/// All points nearer than `distance` to the solid, or, where it is below zero, those farther than −distance from
/// everything outside: the Minkowski sum or difference with a ball, round around edges.
///
/// Error: within one cell of the sampling grid. Cost: about 10 µs per sample.
/// @param distance  model units, finite
/// @throws InvalidInput  the distance is not finite, or a point cloud
Shape offset(Shape shape, double distance);
/// Offset there and back: fills (closing) or cuts off (opening) what is narrower than twice the radius.
/// @throws InvalidInput  the radius is not above 0
Shape closing(Shape shape, double radius);
Shape opening(Shape shape, double radius);

/// The shape moved, turned, scaled, mirrored.
/// @throws InvalidInput  the transform is singular or not finite, or would stretch an offset unevenly
Shape transformed(const Shape& shape, const Affine& transform);

/// The shape scaled to another unit, with a finding that says so; as it is where its own unit is not known.
/// @throws InvalidInput  as transformed()
Shape converted(const Shape& shape, LengthUnit unit);

}  // namespace evenmesh
