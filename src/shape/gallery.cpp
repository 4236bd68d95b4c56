#include <memory>
#include <string>

#include "evenmesh/error.h"
#include "evenmesh/shape.h"
#include "shape/expression.h"
#include "shape/expression_field.h"
#include "shape/field.h"
#include "shape/fractals.h"
#include "shape/suggestions.h"

namespace evenmesh {
namespace {

/// A gallery entry and how it is made: by its formula, or where that is words, by a function.
struct Exhibit {
  GalleryEntry entry;
  Box bounds;
  std::shared_ptr<const Field> (*make)() = nullptr;
};

Box cube(double half) {
  return {{-half, -half, -half}, {half, half, half}};
}
Box box(double x, double y, double z) {
  return {{-x, -y, -z}, {x, y, z}};
}

/// Middle thirds of level 1…n are taken out where at least two coordinates lie in them: where the second smallest
/// distance from the middles is below a sixth. Each level is measured in its own cells and scaled back.
constexpr std::string_view menger_2 =
    "max(max(abs(x-1/2), abs(y-1/2), abs(z-1/2)) - 1/2,"
    " 1/6 - max(min(abs(mod(x,1)-1/2), abs(mod(y,1)-1/2)),"
    " min(max(abs(mod(x,1)-1/2), abs(mod(y,1)-1/2)), abs(mod(z,1)-1/2))),"
    " (1/6 - max(min(abs(mod(3x,1)-1/2), abs(mod(3y,1)-1/2)),"
    " min(max(abs(mod(3x,1)-1/2), abs(mod(3y,1)-1/2)), abs(mod(3z,1)-1/2))))/3)";
constexpr std::string_view menger_3 =
    "max(max(abs(x-1/2), abs(y-1/2), abs(z-1/2)) - 1/2,"
    " 1/6 - max(min(abs(mod(x,1)-1/2), abs(mod(y,1)-1/2)),"
    " min(max(abs(mod(x,1)-1/2), abs(mod(y,1)-1/2)), abs(mod(z,1)-1/2))),"
    " (1/6 - max(min(abs(mod(3x,1)-1/2), abs(mod(3y,1)-1/2)),"
    " min(max(abs(mod(3x,1)-1/2), abs(mod(3y,1)-1/2)), abs(mod(3z,1)-1/2))))/3,"
    " (1/6 - max(min(abs(mod(9x,1)-1/2), abs(mod(9y,1)-1/2)),"
    " min(max(abs(mod(9x,1)-1/2), abs(mod(9y,1)-1/2)), abs(mod(9z,1)-1/2))))/9)";

const std::vector<Exhibit>& exhibits() {
  static const std::vector<Exhibit> all{
      {{"sphere", "r - 1", "sphere", 2}, cube(1.1)},
      {{"torus", "sqrt((sqrt(x^2+y^2)-1)^2+z^2) - 0.35", "torus", 0}, box(1.4, 1.4, 0.4)},
      {{"thin-torus", "sqrt((sqrt(x^2+y^2)-1)^2+z^2) - 0.04", "torus", 0}, box(1.1, 1.1, 0.1)},
      {{"rounded-box",
        "sqrt(max(abs(x)-0.9,0)^2+max(abs(y)-0.6,0)^2+max(abs(z)-0.4,0)^2)"
        " + min(max(abs(x)-0.9,abs(y)-0.6,abs(z)-0.4),0) - 0.1",
        "sphere", 2},
       box(1.02, 0.72, 0.52)},
      {{"cube", "max(abs(x),abs(y),abs(z)) - 1", "sphere, 12 sharp edges", 2}, cube(1.1)},
      {{"thin-plate", "max(abs(x)-0.5, abs(y)-0.5, abs(z)-0.005)", "sphere, 12 sharp edges", 2}, box(0.51, 0.51, 0.01)},
      {{"touching-balls",
        "min(sqrt((x-1/2)^2+y^2+z^2), sqrt((x+1/2)^2+y^2+z^2)) - 1/2",
        "two balls that meet in one point: one body or two",
        {}},
       box(1.02, 0.52, 0.52)},
      {{"trig", "x^2+y^2+z^2+sin(4x)-cos(4y)+sin(4z)", "not known in closed form", {}}, cube(2.2)},
      {{"octic", "2x^2(3-4x^2)^2+2y^2(3-4y^2)^2+2z^2(3-4z^2)^2 = 3", "genus 28", -54}, cube(1.05)},
      {{"octic-balls", "2x^2(3-4x^2)^2+2y^2(3-4y^2)^2+2z^2(3-4z^2)^2 = 1.6", "27 spheres", 54}, cube(1.05)},
      {{"klein",
        "(x^2+y^2+z^2+2y-1)((x^2+y^2+z^2-2y-1)^2-8z^2)+16xz(x^2+y^2+z^2-2y-1)",
        "boundary of the solid left inside a self-crossing Klein bottle",
        {}},
       cube(4.5)},
      {{"tangle", "x^4-5x^2+y^4-5y^2+z^4-5z^2+11.8", "genus 5", -8}, cube(2.6)},
      {{"heart", "(x^2+9y^2/4+z^2-1)^3-x^2z^3-9y^2z^3/80", "sphere", 2}, cube(1.4)},
      {{"barth",
        "max(4((3+sqrt(5))/2*x^2-y^2)((3+sqrt(5))/2*y^2-z^2)((3+sqrt(5))/2*z^2-x^2)"
        "-(2+sqrt(5))(x^2+y^2+z^2-1)^2, r-1.9)",
        "65 nodes, cut by a ball",
        {}},
       cube(1.95)},
      {{"gyroid",
        "max(abs(sin(2pi x)cos(2pi y)+sin(2pi y)cos(2pi z)+sin(2pi z)cos(2pi x))-0.35, r-1)",
        "sheet between two gyroids, cut by a ball",
        {}},
       cube(1.05)},
      {{"schwarz-p",
        "max(cos(2pi x)+cos(2pi y)+cos(2pi z), max(abs(x),abs(y),abs(z))-0.95)",
        "one side of Schwarz's P surface, cut by a cube",
        {}},
       cube(1)},
      {{"menger-2", menger_2, "genus 81", -160}, {{-0.02, -0.02, -0.02}, {1.02, 1.02, 1.02}}},
      {{"menger-3", menger_3, "genus 1409", -2816}, {{-0.02, -0.02, -0.02}, {1.02, 1.02, 1.02}}},
      {{"julia", "orbits of q^2 + (0.1, 0.2, 0.3, 0), q = (x, y, z, 0), within 2 after 16 steps", "fractal", {}, true},
       cube(1.6),
       [] {
         return make_julia({0.1, 0.2, 0.3, 0.0});
       }},
      {{"mandelbulb-7", "orbits of p^7 + p0 within 2 after 12 steps", "fractal", {}, true},
       cube(1.25),
       [] { return make_mandelbulb(7); }},
      {{"mandelbulb-8", "orbits of p^8 + p0 within 2 after 12 steps", "fractal", {}, true},
       cube(1.25),
       [] { return make_mandelbulb(8); }},
  };
  return all;
}

}  // namespace

const std::vector<GalleryEntry>& gallery() {
  static const std::vector<GalleryEntry> entries = [] {
    std::vector<GalleryEntry> list;
    for (const Exhibit& exhibit : exhibits()) list.push_back(exhibit.entry);
    return list;
  }();
  return entries;
}

Shape gallery_shape(std::string_view name) {
  std::vector<std::string_view> names;
  for (const Exhibit& exhibit : exhibits()) {
    if (exhibit.entry.name == name) {
      const auto field = exhibit.make ? exhibit.make() : make_graph_field(parse_expression(exhibit.entry.formula));
      return Shape{std::string(name), exhibit.bounds, field, false};
    }
    names.push_back(exhibit.entry.name);
  }
  std::string message = "no built-in shape is called '" + std::string(name.substr(0, 60)) + "'";
  const std::string guess = did_you_mean(name, names);
  if (!guess.empty()) throw InvalidInput(message + guess);
  for (std::size_t i = 0; i < names.size(); ++i) message += (i == 0 ? "; there are " : ", ") + std::string(names[i]);
  throw InvalidInput(message);
}

}  // namespace evenmesh
