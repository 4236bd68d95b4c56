/// evenmesh mesh: the main job.

#include <memory>

#include "command.h"
#include "meshing.h"

namespace evenmesh::cli {
namespace {

constexpr const char* inputs =
    "mesh file (.stl .obj .ply .off .glb .3mf), points (.xyz .pts .pwn .csv .pcd .ply),\nscene (.json .csg), - for "
    "standard "
    "input, or gallery:NAME";

}  // namespace

void add_mesh_command(CLI::App& app, Action& action) {
  const auto a = std::make_shared<MeshingArguments>();
  CLI::App* command = app.add_subcommand("mesh", "any surface in, an even triangle mesh out");
  command->footer(
      "Examples:\n  evenmesh mesh scan.stl -n 20000 -o even.ply\n  evenmesh mesh -e 'x^2+y^2+z^2-1' -l 0.05 -o "
      "ball.obj\n"
      "  evenmesh mesh gallery:octic -n 20000 -o octic.ply --report octic.html\n");
  add_input_options(*command, *a, inputs);
  add_raster_options(*command, *a);
  add_meshing_options(*command, *a);
  command->callback([a, &action] { action = [a] { return run_meshing(*a); }; });
}

void add_wrap_command(CLI::App& app, Action& action) {
  const auto a = std::make_shared<MeshingArguments>();
  a->wrap = true;
  a->method = "shell";
  CLI::App* command = app.add_subcommand("wrap", "closed mesh around anything: sheets, soups, points");
  command->footer(
      "The outer side of a shell of voxels: one voxel outside of the input; holes and gaps narrower than\ntwice "
      "--thickness are closed, wider ones lead inside.\n"
      "Example:\n  evenmesh wrap scan.pts -n 20000 --thickness 4 -o closed.stl\n");
  add_input_options(*command, *a, inputs);
  add_raster_options(*command, *a);
  add_meshing_options(*command, *a);
  command->callback([a, &action] { action = [a] { return run_meshing(*a); }; });
}

}  // namespace evenmesh::cli
