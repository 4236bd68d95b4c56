#pragma once
/// Enumerators by name, as the command line, JSON and other faces spell them.

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "evenmesh/io.h"
#include "evenmesh/mesh_shape.h"
#include "evenmesh/repaired.h"
#include "evenmesh/set_operation.h"

namespace evenmesh {

template <typename Enum>
struct Named {
  Enum value;
  std::string_view name;
};

/// All enumerators with their names, in the order in which help lists them; names are lower case, words joined by '-'.
/// Made for the types below: another one does not link.
template <typename Enum>
std::span<const Named<Enum>> names();

template <>
std::span<const Named<Method>> names();  ///< auto, raster, shell
template <>
std::span<const Named<Quality>> names();  ///< fast, normal, high
template <>
std::span<const Named<Optimizer>> names();  ///< lbfgs, lloyd
template <>
std::span<const Named<Start>> names();  ///< random, blue-noise, coarse-to-fine
template <>
std::span<const Named<Connect>> names();  ///< complex, flood, fragments
template <>
std::span<const Named<TopologyRule>> names();  ///< keep, simplify
template <>
std::span<const Named<Placement>> names();  ///< centroid, constrained, quadric
template <>
std::span<const Named<Hull>> names();  ///< auto, outer, oriented, all, wrap
template <>
std::span<const Named<SetOperation>> names();  ///< union, intersection, difference
template <>
std::span<const Named<MeshFormat>> names();  ///< ply, obj, stl, off, glb, 3mf

/// The name of an enumerator; "" of a value that is none.
template <typename Enum>
std::string_view name_of(Enum value) {
  for (const Named<Enum>& entry : names<Enum>())
    if (entry.value == value) return entry.name;
  return {};
}

/// The enumerator of that name, spelt exactly so.
template <typename Enum>
std::optional<Enum> value_of(std::string_view name) {
  for (const Named<Enum>& entry : names<Enum>())
    if (entry.name == name) return entry.value;
  return std::nullopt;
}

/// All names with a separator between them: "auto, raster, shell", "fast|normal|high".
template <typename Enum>
std::string joined_names(std::string_view separator = ", ") {
  std::string text;
  for (const Named<Enum>& entry : names<Enum>()) {
    if (!text.empty()) text += separator;
    text += entry.name;
  }
  return text;
}

}  // namespace evenmesh
