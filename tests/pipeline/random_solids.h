#pragma once
/// Random trees of booleans over built-in solids and meshes, the same for the same seed.

#include <numbers>
#include <string>

#include "core/random.h"
#include "evenmesh/solid.h"
#include "geometry/primitives.h"

namespace evenmesh {

/// A prism around the z axis between −1 and 1.
inline Mesh make_prism(int sides, double radius = 1) {
  Mesh mesh;
  for (int i = 0; i < sides; ++i)
    for (const double z : {-1.0, 1.0}) {
      const double turn = 2 * std::numbers::pi * i / sides;
      mesh.vertices.push_back({radius * std::cos(turn), radius * std::sin(turn), z});
    }
  const auto at = [&](int i, int top) { return static_cast<std::uint32_t>(2 * (i % sides) + top); };
  for (int i = 0; i < sides; ++i) {
    mesh.triangles.push_back({at(i, 0), at(i + 1, 0), at(i + 1, 1)});
    mesh.triangles.push_back({at(i, 0), at(i + 1, 1), at(i, 1)});
    if (i == 0 || i + 1 == sides) continue;
    mesh.triangles.push_back({at(0, 0), at(i + 1, 0), at(i, 0)});
    mesh.triangles.push_back({at(0, 1), at(i, 1), at(i + 1, 1)});
  }
  return mesh;
}

class RandomSolids {
 public:
  explicit RandomSolids(std::uint64_t seed) : random_(seed) {}

  /// Two to seven solids, joined by one to six booleans.
  Shape tree() {
    Shape shape = moved(base());
    const std::size_t operations = 1 + random_.below(6);
    for (std::size_t i = 0; i < operations; ++i) {
      Shape other = moved(base());
      switch (random_.below(4)) {
        case 0:
          other = unite({other, moved(base())});
          ++i;
          break;
        case 1:
          if (operations > 3) other = subtract(other, {moved(base())}), ++i;
          break;
        default:
          break;
      }
      const std::size_t kind = random_.below(5);
      shape = kind < 2   ? unite({shape, other})
              : kind < 4 ? subtract(shape, {other})
                         : intersect({shape, unite({other, moved(base())})});
    }
    shape.name = "random solid";
    return shape;
  }
  std::size_t vertices() { return 2000 + random_.below(18001); }

 private:
  /// All about as large as the unit ball.
  Shape base() {
    switch (random_.below(14)) {
      case 0:
        return gallery_shape("sphere");
      case 1:
        return gallery_shape("torus");
      case 2:
        return gallery_shape("rounded-box");
      case 3:
        return transformed(gallery_shape("cube"), scale(0.6));
      case 4:
        return transformed(gallery_shape("heart"), scale(0.8));
      case 5:
        return transformed(gallery_shape("tangle"), scale(0.4));
      case 6:
        return transformed(gallery_shape("trig"), scale(0.5));
      case 7:
        return gallery_shape("thin-torus");
      case 8:
        return shape_from_mesh(make_icosphere(2));
      case 9:
        return shape_from_mesh(make_torus(0.8, 0.3));
      case 10:
        return shape_from_mesh(make_box({0.8, 0.5, 0.3}));
      case 11:
        return shape_from_mesh(make_tetrahedron());
      case 12:
        return transformed(shape_from_mesh(make_prism(6)), Affine::scale({0.4, 0.4, 0.9}));
      default:
        return transformed(shape_from_mesh(make_prism(40)), Affine::scale({0.5, 0.5, 0.8}));
    }
  }
  static Affine scale(double by) { return Affine::scale({by, by, by}); }
  Vec3 direction() {
    const double x = random_.gaussian(), y = random_.gaussian(), z = random_.gaussian();
    return {x, y, z};
  }
  Shape moved(const Shape& shape) {
    const double size = 0.5 + 0.7 * random_.uniform();
    const Affine turned = Affine::rotate(direction(), 360 * random_.uniform()).after(scale(size));
    const Vec3 by = 0.4 * direction();
    return transformed(shape, Affine::translate(by).after(turned));
  }

  Random random_;
};

}  // namespace evenmesh
