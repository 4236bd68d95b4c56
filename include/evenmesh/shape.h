#pragma once
/// What can be meshed: triangle meshes as solids, implicit expressions, indicator functions, point clouds, built-in
/// shapes; solids made of these are in solid.h.

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "evenmesh/density.h"
#include "evenmesh/findings.h"
#include "evenmesh/mesh.h"
#include "evenmesh/points.h"

namespace evenmesh {

class Field;
class RaySource;
struct Compound;

/// What is inside a triangle mesh: points around which it winds, or those that it winds around the right way, so that
/// parts which face inward bound nothing.
enum class Winding { any, positive };

/// Something with a surface. Cheap to copy.
struct Shape {
  std::string name;  ///< for messages
  Box bounds;        ///< where the surface is sought, model units; empty: to be found (implicit shapes only)
  /// A triangle mesh is a solid by its winding number (non-zero = inside); a field is a solid where f < 0; a point
  /// cloud is a surface without an inside; a compound is a solid made of others (solid.h); a sampler is a solid that
  /// tells where rays meet it (raster.h).
  std::variant<std::shared_ptr<const Mesh>, std::shared_ptr<const Field>, std::shared_ptr<const PointCloud>,
               std::shared_ptr<const Compound>, std::shared_ptr<const RaySource>>
      what;
  /// The solid leaves its bounds and is closed by them on purpose, or may be (then a cut is worth a warning).
  bool capped_by_bounds = false;
  Winding winding = Winding::any;    ///< of a mesh
  std::optional<LengthUnit> unit{};  ///< of the model, where it is known; the mesh made of it gets it, too
  std::vector<Finding> findings{};   ///< what reading it left out or changed; a report of it begins with these

  const Mesh* mesh() const {
    const auto* p = std::get_if<std::shared_ptr<const Mesh>>(&what);
    return p ? p->get() : nullptr;
  }
  const Field* field() const {
    const auto* p = std::get_if<std::shared_ptr<const Field>>(&what);
    return p ? p->get() : nullptr;
  }
  const PointCloud* points() const {
    const auto* p = std::get_if<std::shared_ptr<const PointCloud>>(&what);
    return p ? p->get() : nullptr;
  }
  const Compound* compound() const {
    const auto* p = std::get_if<std::shared_ptr<const Compound>>(&what);
    return p ? p->get() : nullptr;
  }
  const RaySource* ray_source() const {
    const auto* p = std::get_if<std::shared_ptr<const RaySource>>(&what);
    return p ? p->get() : nullptr;
  }
};

/// A solid bounded by triangles, in any orientation; bounds are those of the used vertices.
/// @throws UnusableInput if the mesh has no triangle; InvalidInput if an index or coordinate is invalid
Shape shape_from_mesh(Mesh mesh, std::string name = "mesh");

/// The surface that points were taken from.
/// @throws UnusableInput if there is no point; InvalidInput if a coordinate is not finite or the normals are not one
/// per
///         point
Shape shape_from_points(PointCloud points, std::string name = "points");

/// The solid f < 0 of an expression in x, y, z (and r = √(x²+y²+z²)).
///
/// Operators + - * / ^ (right-associative, binds tighter than unary minus), implicit multiplication (4x, 2(x+1), x y);
/// functions sin cos tan asin acos atan atan2 exp log sqrt abs min max floor mod sign; constants pi, e; `parameters`.
/// One '=' is allowed: "a = b" stands for a − (b).
/// @param bounds  empty: a box is sought (interval arithmetic, or at points within ±1024 where that proves too little)
/// when the shape is sampled
/// @throws InvalidInput  with the column (1-based) and a caret under it
Shape shape_from_expression(std::string_view expression, const std::map<std::string, double>& parameters = {},
                            const Box& bounds = {});

/// An expression in x, y, z as shape_from_expression() reads it, as a density.
/// @throws InvalidInput  with the column (1-based) and a caret under it
Density density_from_expression(std::string_view expression, const std::map<std::string, double>& parameters = {});

/// What density_from_expression() made a density of; none of any other function.
struct DensityExpression {
  std::string expression;
  std::map<std::string, double> parameters{};
  friend bool operator==(const DensityExpression&, const DensityExpression&) = default;
};
std::optional<DensityExpression> expression_of(const Density& density);

/// A box. @throws InvalidInput if it is empty
Shape shape_from_box(const Box& box, std::string name = "box");

/// The solid where inside(p) is true. Normals are estimated from neighbouring samples.
/// @param inside  must be callable from several threads at once
/// @throws InvalidInput if bounds are empty
Shape shape_from_indicator(std::function<bool(const Vec3&)> inside, const Box& bounds, std::string name = "indicator");

/// One built-in shape; see gallery_names().
/// @throws InvalidInput  unknown name; the message lists close ones
Shape gallery_shape(std::string_view name);

struct GalleryEntry {
  std::string_view name, formula;
  std::string_view topology;  ///< what is known of it, in words
  std::optional<int> euler;   ///< Euler number of the surface, when known
  bool fractal = false;
};
const std::vector<GalleryEntry>& gallery();

}  // namespace evenmesh
