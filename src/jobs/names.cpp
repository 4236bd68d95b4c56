#include "evenmesh/names.h"

#include <array>

namespace evenmesh {

template <>
std::span<const Named<Method>> names() {
  static constexpr std::array<Named<Method>, 3> all{
      {{Method::automatic, "auto"}, {Method::raster, "raster"}, {Method::shell, "shell"}}};
  return all;
}

template <>
std::span<const Named<Quality>> names() {
  static constexpr std::array<Named<Quality>, 3> all{
      {{Quality::fast, "fast"}, {Quality::normal, "normal"}, {Quality::high, "high"}}};
  return all;
}

template <>
std::span<const Named<Optimizer>> names() {
  static constexpr std::array<Named<Optimizer>, 2> all{{{Optimizer::lbfgs, "lbfgs"}, {Optimizer::lloyd, "lloyd"}}};
  return all;
}

template <>
std::span<const Named<Start>> names() {
  static constexpr std::array<Named<Start>, 3> all{
      {{Start::random, "random"}, {Start::blue_noise, "blue-noise"}, {Start::coarse_to_fine, "coarse-to-fine"}}};
  return all;
}

template <>
std::span<const Named<Connect>> names() {
  static constexpr std::array<Named<Connect>, 3> all{
      {{Connect::complex, "complex"}, {Connect::flood, "flood"}, {Connect::fragments, "fragments"}}};
  return all;
}

template <>
std::span<const Named<TopologyRule>> names() {
  static constexpr std::array<Named<TopologyRule>, 2> all{
      {{TopologyRule::keep, "keep"}, {TopologyRule::simplify, "simplify"}}};
  return all;
}

template <>
std::span<const Named<Placement>> names() {
  static constexpr std::array<Named<Placement>, 3> all{
      {{Placement::centroid, "centroid"}, {Placement::constrained, "constrained"}, {Placement::quadric, "quadric"}}};
  return all;
}

template <>
std::span<const Named<Hull>> names() {
  static constexpr std::array<Named<Hull>, 5> all{{{Hull::automatic, "auto"},
                                                   {Hull::outer, "outer"},
                                                   {Hull::oriented, "oriented"},
                                                   {Hull::all, "all"},
                                                   {Hull::wrap, "wrap"}}};
  return all;
}

template <>
std::span<const Named<SetOperation>> names() {
  static constexpr std::array<Named<SetOperation>, 3> all{{{SetOperation::unite, "union"},
                                                           {SetOperation::intersect, "intersection"},
                                                           {SetOperation::subtract, "difference"}}};
  return all;
}

template <>
std::span<const Named<MeshFormat>> names() {
  static constexpr std::array<Named<MeshFormat>, 6> all{{{MeshFormat::ply, "ply"},
                                                         {MeshFormat::obj, "obj"},
                                                         {MeshFormat::stl, "stl"},
                                                         {MeshFormat::off, "off"},
                                                         {MeshFormat::glb, "glb"},
                                                         {MeshFormat::threemf, "3mf"}}};
  return all;
}

}  // namespace evenmesh
