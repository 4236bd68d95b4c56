/// evenmesh gallery: the built-in shapes.

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "command.h"
#include "meshing.h"
#include "output.h"

namespace evenmesh::cli {
namespace {

std::string list_text() {
  std::string text;
  for (const GalleryEntry& entry : gallery()) {
    // A few formulas fill a screen; --json has them in full.
    const bool long_one = entry.formula.size() > 110;
    const std::string formula =
        fmt::format("{}{}", entry.formula.substr(0, long_one ? 100 : 110), long_one ? " …" : "");
    text += fmt::format("{:<15} {}\n{:<15} {}\n", entry.name, formula, "", entry.topology);
  }
  return text + "\nMesh one: evenmesh gallery NAME -n 5000 -o NAME.ply\n";
}

std::string list_json() {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const GalleryEntry& entry : gallery()) {
    nlohmann::ordered_json item{{"name", entry.name}, {"formula", entry.formula}, {"topology", entry.topology}};
    item["euler"] = nullptr;
    if (entry.euler) item["euler"] = *entry.euler;
    item["fractal"] = entry.fractal;
    list.push_back(std::move(item));
  }
  return list.dump(2) + "\n";
}

int run_gallery(MeshingArguments arguments, const std::string& name) {
  if (name.empty()) {
    if (!arguments.output.empty()) throw InvalidInput("-o needs a shape; give its NAME, evenmesh gallery lists them");
    // With a shape, --json is a file for the figures; without one, "-" or no value lists for machines.
    write_output("-", arguments.json.empty() ? list_text() : list_json());
    return Status::done;
  }
  constexpr std::string_view prefix = "gallery:";
  arguments.input.positional = {name.starts_with(prefix) ? name : fmt::format("{}{}", prefix, name)};
  return run_meshing(std::move(arguments));
}

}  // namespace

void add_gallery_command(CLI::App& app, Action& action) {
  const auto a = std::make_shared<MeshingArguments>();
  const auto name = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("gallery", "the built-in shapes: lists them, or meshes one");
  command->add_option("NAME", *name, "shape to mesh; none: list all with formula and topology (--json: for machines)")
      ->type_name("");
  add_meshing_options(*command, *a);
  // Listing takes a bare --json; the file name is needed only beside NAME.
  command->get_option("--json")->expected(0, 1)->default_str("-");
  command->callback([a, name, command, &action] {
    if (command->count("--json") > 0 && a->json.empty()) a->json = "-";
    action = [a, name] { return run_gallery(*a, *name); };
  });
}

}  // namespace evenmesh::cli
