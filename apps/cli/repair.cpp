/// evenmesh repair: a closed two-manifold mesh of a defective one.

#include "evenmesh/repair.h"

#include <fmt/format.h>

#include <memory>

#include "command.h"
#include "meshing.h"
#include "terminal.h"
#include "values.h"

namespace evenmesh::cli {
namespace {

constexpr double min_solidity = 0.6;  ///< below it there is no inside to speak of

struct RepairArguments {
  MeshingArguments meshing;
  std::string hull = "auto";
};

std::string said_of(const MeshDefects& d) {
  std::string text;
  const auto add = [&](std::size_t count, const char* what) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
  };
  add(d.welded_vertices, "vertices welded");
  add(d.degenerate_triangles, "degenerate triangles left out");
  add(d.repeated_triangles, "repeated triangles left out");
  add(d.turned_triangles, "triangles turned");
  add(d.boundary_edges, "boundary edges");
  add(d.non_manifold_edges, "non-manifold edges");
  return text.empty() ? "no defects of connection" : text;
}

int run_repair(RepairArguments a) {
  choice("--hull", a.hull, {"auto", "outer", "oriented", "all", "wrap"});
  Operation operation{.options = {{"hull", a.hull}}};
  operation.prepare = [hull = a.hull](Shape& shape, MeshOptions& options, Talk talk) {
    if (!shape.mesh())
      throw InvalidInput("repair takes a triangle mesh; other inputs have nothing to repair: use mesh");
    MeshDefects defects;
    Mesh mesh = cleaned(*shape.mesh(), defects);
    if (mesh.triangles.empty()) throw UnusableInput(shape.name + " has no triangle with an area");
    if (talk != Talk::quiet) say("note", said_of(defects));
    shape = shape_from_mesh(std::move(mesh), shape.name);
    const bool sheets = hull == "auto" && solidity(*shape.mesh()) < min_solidity;
    if (hull == "wrap" || sheets) {
      if (talk != Talk::quiet && sheets)
        say("note", "most of it is sheets without an inside: they are wrapped, one voxel outside (--hull outer: not)");
      options.wrap = true, options.method = Method::shell;
      return;
    }
    std::size_t filled = 0;
    shape = shape_from_mesh(holes_filled(*shape.mesh(), filled), shape.name);
    if (talk != Talk::quiet && filled > 0)
      say("note", fmt::format("{} {} filled", filled, filled == 1 ? "hole" : "holes"));
    options.method = Method::raster;
    options.fill_cavities = hull != "all";
    if (hull == "oriented") shape.winding = Winding::positive;
  };
  return run_meshing(std::move(a.meshing), operation);
}

}  // namespace

void add_repair_command(CLI::App& app, Action& action) {
  const auto a = std::make_shared<RepairArguments>();
  CLI::App* command = app.add_subcommand("repair", "closed two-manifold mesh of a defective one");
  command->footer(
      "Vertices are welded, degenerate and repeated triangles left out, each patch of triangles turned one way. What "
      "rays\n"
      "from three directions find inside becomes the solid: interpenetrating parts are united, holes and gaps are "
      "closed.\n"
      "Examples:\n  evenmesh repair scan.stl -n 20000 -o closed.ply\n"
      "  evenmesh repair assembly.obj --hull oriented -o solid.stl\n");
  command->add_option("INPUT", a->meshing.input.positional, "mesh file, or - for standard input")->type_name("");
  command
      ->add_option("--hull", a->hull,
                   "what becomes the solid: auto|outer|oriented|all|wrap. outer: all that the outside does not reach,\n"
                   "cavities and inner shells are filled; oriented: so, but parts that face inward bound nothing;\n"
                   "all: inner shells are kept; wrap: a closed mesh one voxel outside; auto: wrap for open sheets,\n"
                   "else outer")
      ->type_name("HULL");
  add_meshing_options(*command, a->meshing);
  command->callback([a, &action] { action = [a] { return run_repair(*a); }; });
}

}  // namespace evenmesh::cli
