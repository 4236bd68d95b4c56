/// Scenes as JSON: one node is an object with one key that says what it is (docs/scenes.md).

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "evenmesh/error.h"
#include "scene/json_node.h"
#include "scene/json_text.h"
#include "scene/scene_loader.h"
#include "shape/suggestions.h"

namespace evenmesh {
namespace {

class JsonReader {
 public:
  JsonReader(const Source& source, SceneLoader& loader, const SceneLimits& limits)
      : source_(source), loader_(loader), limits_(limits) {}

  Shape read() const {
    // A node takes three levels at most: itself, an array or "transform", a list in it; and a few for the last.
    const nlohmann::json root = parse_json_text(source_, 3 * limits_.depth + 8);
    const JsonPlace place(source_, root);
    Shape shape = node(place, nullptr, 0);
    shape.name = place.has("name") ? place.member("name").text() : std::string(source_.name);
    return shape;
  }

 private:
  struct Kind {
    const char* key;
    std::vector<const char*> beside;  ///< keys that may stand beside it
    Shape (JsonReader::*read)(const JsonPlace& node, const Affine* placement, std::size_t depth) const;
  };
  static const std::vector<Kind>& kinds();

  static std::string kind_list() {
    std::string list;
    for (const Kind& kind : kinds()) list += (list.empty() ? "" : ", ") + std::string(kind.key);
    return list;
  }

  static const Kind& kind_of(const JsonPlace& place) {
    if (!place.value().is_object()) place.refuse("needs an object with one of the keys " + kind_list());
    const Kind* found = nullptr;
    for (const Kind& kind : kinds()) {
      if (!place.has(kind.key)) continue;
      if (found != nullptr) {
        place.refuse(fmt::format("has both '{}' and '{}'; {}", found->key, kind.key,
                                 takes_one(*found) ? fmt::format("put '{}' into a node under 'of'", kind.key)
                                 : takes_one(kind) ? fmt::format("put '{}' into a node under 'of'", found->key)
                                                   : "put them into two nodes"));
      }
      found = &kind;
    }
    if (found == nullptr) refuse_without_kind(place);
    return *found;
  }

  static bool takes_one(const Kind& kind) {
    return std::any_of(kind.beside.begin(), kind.beside.end(), [](std::string_view key) { return key == "of"; });
  }

  /// One of the keys may be meant to be a known one.
  [[noreturn]] static void refuse_without_kind(const JsonPlace& place) {
    std::vector<std::string_view> known;
    for (const Kind& kind : kinds()) known.push_back(kind.key);
    for (const auto& [key, unused] : place.value().items()) {
      const std::string meant = did_you_mean(in_lower_case(key), known);
      if (!meant.empty()) place.refuse(fmt::format("has the unknown key {}{}", evenmesh::quoted(key), meant));
    }
    place.refuse("needs one of the keys " + kind_list());
  }

  static std::string in_lower_case(std::string text) {
    for (char& c : text)
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
  }

  static std::string what_to_do(const std::string& key, const Kind& kind) {
    for (const std::string_view motion : {"scale", "rotate", "translate", "matrix"})
      if (key == motion) return fmt::format("; put the node under 'of' beside a 'transform' with '{}'", motion);
    std::vector<std::string_view> known(kind.beside.begin(), kind.beside.end());
    const std::string meant = did_you_mean(in_lower_case(key), known);
    return meant.empty() ? "; remove it" : meant;
  }

  static void refuse_other_keys(const JsonPlace& place, const Kind& kind, bool top) {
    constexpr std::array at_top{"name", "units", "$schema"};
    for (const auto& [key, unused] : place.value().items()) {
      const auto is_key = [&name = key](const char* known) { return name == known; };
      if (key == kind.key || std::any_of(kind.beside.begin(), kind.beside.end(), is_key)) continue;
      if (!std::any_of(at_top.begin(), at_top.end(), is_key)) {
        place.refuse(fmt::format("has the unknown key {} beside '{}'{}", evenmesh::quoted(key), kind.key,
                                 what_to_do(key, kind)));
      }
      if (!top) place.refuse(fmt::format("has {}, which is for the top of the file only", evenmesh::quoted(key)));
    }
  }

  /// They say what a length of 1 means; meshes that know theirs are converted.
  void read_units(const JsonPlace& place) const {
    if (!place.has("units")) return;
    const JsonPlace units = place.member("units");
    const std::optional<LengthUnit> unit = unit_of_name(units.text());
    if (!unit) units.refuse(fmt::format("is none of {}; take one of them, or leave it out", unit_names()));
    loader_.set_unit(*unit);
  }

  Shape node(const JsonPlace& place, const Affine* placement, std::size_t depth) const {
    loader_.run().throw_if_cancelled();
    if (depth >= limits_.depth) {
      place.refuse(fmt::format("is nested too deeply; a scene may have {} nodes within each other", limits_.depth));
    }
    const Kind& kind = kind_of(place);
    refuse_other_keys(place, kind, depth == 0);
    if (depth == 0) read_units(place);
    return (this->*kind.read)(place, placement, depth);
  }

  /// Runs what may complain without knowing where it is.
  template <typename Make>
  static auto at(const JsonPlace& place, const Make& make) {
    try {
      return make();
    } catch (const Cancelled&) {
      throw;
    } catch (const NotAvailable& error) {
      throw NotAvailable(place.prefix() + error.what());
    } catch (const Error& error) {
      place.refuse(error.what());
    }
  }

  std::vector<Shape> operands(const JsonPlace& list, const Affine* placement, std::size_t depth) const {
    if (!list.value().is_array() || list.value().empty()) list.refuse("needs an array of at least one node");
    std::vector<Shape> shapes;
    for (std::size_t i = 0; i < list.value().size(); ++i) {
      const JsonPlace element = list.element(i);
      shapes.push_back(node(element, placement, depth + 1));
      if (shapes.back().points()) element.refuse("is a point cloud, which has no inside; only solids can be combined");
    }
    return shapes;
  }

  Shape read_union(const JsonPlace& place, const Affine* placement, std::size_t depth) const {
    const JsonPlace list = place.member("union");
    std::vector<Shape> shapes = operands(list, placement, depth);
    return at(list, [&] { return unite(std::move(shapes)); });
  }

  Shape read_intersection(const JsonPlace& place, const Affine* placement, std::size_t depth) const {
    const JsonPlace list = place.member("intersection");
    std::vector<Shape> shapes = operands(list, placement, depth);
    return at(list, [&] { return intersect(std::move(shapes)); });
  }

  Shape read_difference(const JsonPlace& place, const Affine* placement, std::size_t depth) const {
    const JsonPlace list = place.member("difference");
    std::vector<Shape> shapes = operands(list, placement, depth);
    Shape first = std::move(shapes.front());
    shapes.erase(shapes.begin());
    return at(list, [&] { return subtract(std::move(first), std::move(shapes)); });
  }

  /// The node in "of".
  Shape inner(const JsonPlace& place, const char* key, const Affine* placement, std::size_t depth) const {
    if (!place.has("of")) place.refuse(fmt::format("needs 'of', the node that '{}' is done to", key));
    return node(place.member("of"), placement, depth + 1);
  }

  /// Offsets are measured where they stand; what is around them moves the result.
  template <typename Make>
  Shape distanced(const JsonPlace& place, const char* key, const Affine* placement, std::size_t depth,
                  const Make& make) const {
    const JsonPlace distance = place.member(key);
    const double value = distance.number();
    Shape shape = inner(place, key, nullptr, depth);
    return at(distance, [&] { return loader_.placed(make(std::move(shape), value), placement); });
  }

  Shape read_offset(const JsonPlace& place, const Affine* placement, std::size_t depth) const {
    return distanced(place, "offset", placement, depth, offset);
  }
  Shape read_closing(const JsonPlace& place, const Affine* placement, std::size_t depth) const {
    return distanced(place, "closing", placement, depth, closing);
  }
  Shape read_opening(const JsonPlace& place, const Affine* placement, std::size_t depth) const {
    return distanced(place, "opening", placement, depth, opening);
  }

  /// Handed down to the leaves, so that each of them is moved once.
  Shape read_moved(const JsonPlace& place, const Affine* placement, std::size_t depth) const {
    const JsonPlace transform = place.member("transform");
    const Affine own = read_transform(transform);
    const Affine both = placement ? placement->after(own) : own;
    at(transform, [&] { return both.inverse(); });
    return inner(place, "transform", &both, depth);
  }

  Shape read_mesh_node(const JsonPlace& place, const Affine* placement, std::size_t) const {
    const JsonPlace given = place.member("mesh");
    const std::string name = given.text();
    return at(given, [&] { return loader_.placed(loader_.mesh_file(name), placement); });
  }

  Shape read_points_node(const JsonPlace& place, const Affine* placement, std::size_t) const {
    const JsonPlace given = place.member("points");
    const std::string name = given.text();
    return at(given, [&] { return loader_.placed(loader_.point_file(name), placement); });
  }

  Shape read_gallery(const JsonPlace& place, const Affine* placement, std::size_t) const {
    const JsonPlace given = place.member("gallery");
    const std::string name = given.text();
    return at(given, [&] { return loader_.placed(gallery_shape(name), placement); });
  }

  /// Empty where none are given.
  static Box bounds_of(const JsonPlace& place) {
    if (!place.has("bounds")) return {};
    const JsonPlace six = place.member("bounds");
    const auto b = six.numbers<6>();
    if (!(b[0] < b[3] && b[1] < b[4] && b[2] < b[5])) six.refuse("needs x0 < x1, y0 < y1 and z0 < z1");
    return {{b[0], b[1], b[2]}, {b[3], b[4], b[5]}};
  }

  Shape read_implicit(const JsonPlace& place, const Affine* placement, std::size_t) const {
    const Box bounds = bounds_of(place);
    std::map<std::string, double> parameters;
    if (place.has("parameters")) {
      const JsonPlace list = place.member("parameters");
      if (!list.value().is_object()) list.refuse("needs an object of numbers, one for each name");
      for (const auto& [name, unused] : list.value().items()) parameters[name] = list.member(name.c_str()).number();
    }
    const JsonPlace expression = place.member("implicit");
    const std::string text = expression.text();
    return at(expression, [&] { return loader_.placed(shape_from_expression(text, parameters, bounds), placement); });
  }

  /// Values of uniforms and macros: numbers, lists of numbers, or texts.
  static std::map<std::string, std::string> definitions_of(const JsonPlace& list) {
    std::map<std::string, std::string> definitions;
    if (!list.value().is_object()) list.refuse("needs an object of numbers, lists of numbers or texts");
    for (const auto& [name, value] : list.value().items()) {
      const JsonPlace given = list.member(name.c_str());
      std::string& text = definitions[name];
      if (value.is_string()) {
        text = given.text();
      } else if (value.is_array()) {
        for (std::size_t i = 0; i < value.size(); ++i)
          text += fmt::format("{}{}", i == 0 ? "" : ",", given.element(i).number());
      } else {
        text = fmt::format("{}", given.number());
      }
    }
    return definitions;
  }

  Shape read_shader(const JsonPlace& place, const Affine* placement, std::size_t) const {
    GlslOptions options;
    options.bounds = bounds_of(place);
    if (place.has("entry")) options.entry = place.member("entry").text();
    if (place.has("lipschitz")) options.lipschitz = place.member("lipschitz").number();
    if (place.has("level")) options.level = place.member("level").number();
    if (place.has("parameters")) options.definitions = definitions_of(place.member("parameters"));
    const JsonPlace given = place.member("glsl");
    const std::string name = given.text();
    return at(given, [&] { return loader_.placed(loader_.shader_file(name, options), placement); });
  }
  /// What two shaders draw; "default" stands for a built-in one.
  Shape read_raster_node(const JsonPlace& place, const Affine* placement, std::size_t) const {
    const JsonPlace given = place.member("raster");
    if (!given.value().is_array() || given.value().size() != 2)
      given.refuse("needs two files: a vertex and a fragment shader, or \"default\"");
    RasterOptions options;
    options.bounds = bounds_of(place);
    if (place.has("parameters")) options.definitions = definitions_of(place.member("parameters"));
    if (place.has("geometry") == place.has("vertices"))
      place.refuse("needs either 'geometry', a mesh file that is drawn, or 'vertices', a number without a mesh");
    if (place.has("geometry")) {
      const JsonPlace mesh = place.member("geometry");
      const std::string name = mesh.text();
      at(mesh, [&] { options.geometry = *loader_.mesh_file(name).mesh(); });
    } else {
      const JsonPlace count = place.member("vertices");
      const double number = count.number();
      if (!(number >= 3 && number <= 3e8) || number != std::floor(number))
        count.refuse("needs a whole number, 3 to 3e8");
      options.vertex_count = static_cast<std::size_t>(number);
    }
    const std::string vertex = given.element(0).text(), fragment = given.element(1).text();
    return at(given, [&] { return loader_.placed(loader_.raster_files(vertex, fragment, options), placement); });
  }
  Shape read_dexel_node(const JsonPlace& place, const Affine* placement, std::size_t) const {
    const JsonPlace given = place.member("dexels");
    const std::string name = given.text();
    return at(given, [&] { return loader_.placed(loader_.dexel_file(name), placement); });
  }

  const Source& source_;
  SceneLoader& loader_;
  const SceneLimits& limits_;
};

const std::vector<JsonReader::Kind>& JsonReader::kinds() {
  static const std::vector<Kind> all{
      {"union", {}, &JsonReader::read_union},
      {"intersection", {}, &JsonReader::read_intersection},
      {"difference", {}, &JsonReader::read_difference},
      {"offset", {"of"}, &JsonReader::read_offset},
      {"closing", {"of"}, &JsonReader::read_closing},
      {"opening", {"of"}, &JsonReader::read_opening},
      {"transform", {"of"}, &JsonReader::read_moved},
      {"mesh", {}, &JsonReader::read_mesh_node},
      {"implicit", {"bounds", "parameters"}, &JsonReader::read_implicit},
      {"gallery", {}, &JsonReader::read_gallery},
      {"points", {}, &JsonReader::read_points_node},
      {"glsl", {"entry", "parameters", "lipschitz", "level", "bounds"}, &JsonReader::read_shader},
      {"raster", {"geometry", "vertices", "parameters", "bounds"}, &JsonReader::read_raster_node},
      {"dexels", {}, &JsonReader::read_dexel_node},
  };
  return all;
}

}  // namespace

Shape read_json_scene(const Source& source, SceneLoader& loader, const SceneLimits& limits) {
  return JsonReader(source, loader, limits).read();
}

}  // namespace evenmesh
