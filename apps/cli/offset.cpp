/// evenmesh offset: solids grown, shrunk, closed, opened.

#include <fmt/format.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "command.h"
#include "evenmesh/solid.h"
#include "meshing.h"
#include "values.h"

namespace evenmesh::cli {
namespace {

/// Texts of --distance, --closing, --opening; empty: not given.
struct OffsetArguments {
  std::string distance, closing, opening;
};

double radius(const char* option, const std::string& text) {
  const double value = real_number(option, text);
  if (!(value > 0)) throw InvalidInput(fmt::format("{} takes a radius above 0; {} is out of range", option, text));
  return value;
}

Operation operation_of(const OffsetArguments& o) {
  const int given = !o.distance.empty() + !o.closing.empty() + !o.opening.empty();
  if (given != 1) {
    throw InvalidInput(given == 0 ? "no distance; give one of --distance, --closing, --opening"
                                  : "--distance, --closing and --opening exclude each other; give one of them");
  }
  const auto only = [](const auto& make, double value) {
    return [make, value](std::vector<Shape> shapes) { return make(std::move(shapes.at(0)), value); };
  };
  if (!o.closing.empty()) {
    return {.combine = only(closing, radius("--closing", o.closing)), .options = {{"closing", o.closing}}};
  }
  if (!o.opening.empty()) {
    return {.combine = only(opening, radius("--opening", o.opening)), .options = {{"opening", o.opening}}};
  }
  return {.combine = only(offset, real_number("--distance", o.distance)), .options = {{"distance", o.distance}}};
}

}  // namespace

void add_offset_command(CLI::App& app, Action& action) {
  const auto a = std::make_shared<MeshingArguments>();
  const auto o = std::make_shared<OffsetArguments>();
  CLI::App* command = app.add_subcommand("offset", "a solid grown or shrunk by a distance, closed or opened");
  command->footer(
      "Examples:\n  evenmesh offset part.stl --distance 0.5 -n 20000 -o grown.ply\n"
      "  evenmesh offset part.stl --closing 0.2 -n 20000 -o closed.ply\n");
  add_input_options(*command, *a,
                    "mesh file (.stl .obj .ply .off .glb .3mf), scene (.json .csg), - for standard input,\nor "
                    "gallery:NAME");
  const auto option = [&](const char* name, std::string& text, const char* type, const char* description) {
    command->add_option(name, text, description)->type_name(type)->group("How far (one of these)");
  };
  option("--distance", o->distance, "D", "model units: above 0 grows, below 0 shrinks; round around edges");
  option("--closing", o->closing, "R", "grows by R and shrinks again: fills what is narrower than 2R; above 0");
  option("--opening", o->opening, "R", "shrinks by R and grows again: cuts off what is narrower than 2R; above 0");
  add_meshing_options(*command, *a);
  command->callback([a, o, &action] { action = [a, o] { return run_meshing(*a, operation_of(*o)); }; });
}

}  // namespace evenmesh::cli
