/// evenmesh mesh: the main job.

#include <memory>

#include "command.h"
#include "meshing.h"

namespace evenmesh::cli {

namespace {

void add_input(CLI::App& command, MeshingArguments& a) {
  const std::string group = "What goes in";
  command
      .add_option("INPUT", a.input.positional,
                  "mesh file (.stl .obj .ply .off .glb .3mf), points (.xyz .pts .pwn .ply),\n- for standard input, or "
                  "gallery:NAME")
      ->type_name("");
  command
      .add_option("-e,--expression", a.input.expressions,
                  "solid where an expression in x, y, z is below 0, instead of INPUT")
      ->type_name("EXPR")
      ->allow_extra_args(false)
      ->group(group);
  command.add_option("-D,--define", a.definitions, "value of a parameter of the expression, e.g. -D a=0.5")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false)
      ->group(group);
  command.add_option("--entry", a.entry, "function in a GLSL file; not available in this version")
      ->type_name("NAME")
      ->group(group);
}

}  // namespace

void add_mesh_command(CLI::App& app, Action& action) {
  const auto a = std::make_shared<MeshingArguments>();
  CLI::App* command = app.add_subcommand("mesh", "any surface in, an even triangle mesh out");
  command->footer(
      "Examples:\n  evenmesh mesh scan.stl -n 20000 -o even.ply\n  evenmesh mesh -e 'x^2+y^2+z^2-1' -l 0.05 -o "
      "ball.obj\n"
      "  evenmesh mesh gallery:octic -n 20000 -o octic.ply --report octic.html\n");
  add_input(*command, *a);
  add_meshing_options(*command, *a);
  command->callback([a, &action] { action = [a] { return run_meshing(*a); }; });
}

void add_wrap_command(CLI::App& app, Action& action) {
  const auto a = std::make_shared<MeshingArguments>();
  a->wrap = true, a->method = "shell";
  CLI::App* command = app.add_subcommand("wrap", "closed mesh around anything: sheets, soups, points");
  command->footer(
      "The outer side of a shell of voxels: one voxel outside of the input; holes and gaps narrower than\ntwice "
      "--thickness are closed, wider ones lead inside.\n"
      "Example:\n  evenmesh wrap scan.pts -n 20000 --thickness 4 -o closed.stl\n");
  add_input(*command, *a);
  add_meshing_options(*command, *a);
  command->callback([a, &action] { action = [a] { return run_meshing(*a); }; });
}

}  // namespace evenmesh::cli
