/// evenmesh boolean: union, intersection or difference of any inputs.

#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "command.h"
#include "evenmesh/set_operation.h"
#include "meshing.h"
#include "values.h"

namespace evenmesh::cli {
namespace {

int run_boolean(const MeshingArguments& arguments, const std::string& name) {
  const auto set = choice<SetOperation>("boolean", name);
  const Operation operation{.inputs = {2, std::numeric_limits<std::size_t>::max()},
                            .combine = [set](std::vector<Shape> shapes) { return combined(set, std::move(shapes)); },
                            .options = {{"operation", name}}};
  return run_meshing(arguments, operation);
}

}  // namespace

void add_boolean_command(CLI::App& app, Action& action) {
  const auto a = std::make_shared<MeshingArguments>();
  const auto name = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("boolean", "union, intersection or difference of solids");
  command->footer(
      "Operands are the INPUTs in their order, then the expressions; difference takes all others from the\nfirst.\n"
      "Examples:\n  evenmesh boolean difference block.stl drill.obj -n 20000 -o drilled.ply\n"
      "  evenmesh boolean union gallery:sphere -e 'max(abs(x),abs(y),abs(z))-0.8' --bounds -2,-2,-2,2,2,2 -o "
      "both.ply\n");
  command->add_option("OPERATION", *name, "union, intersection or difference")->type_name("")->required();
  add_input_options(*command, *a,
                    "two or more: mesh files (.stl .obj .ply .off .glb .3mf), scenes (.json .csg),\n- for standard "
                    "input, or gallery:NAME");
  add_meshing_options(*command, *a);
  command->callback([a, name, &action] { action = [a, name] { return run_boolean(*a, *name); }; });
}

}  // namespace evenmesh::cli
