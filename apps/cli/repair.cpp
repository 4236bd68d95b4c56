/// evenmesh repair: a closed two-manifold mesh of a defective one.

#include <fmt/format.h>

#include <memory>
#include <string>
#include <utility>

#include "command.h"
#include "evenmesh/repaired.h"
#include "meshing.h"
#include "terminal.h"
#include "values.h"

namespace evenmesh::cli {
namespace {

struct RepairArguments {
  MeshingArguments meshing;
  std::string hull = "auto";
};

/// What was done, as notes on standard error.
void tell(const Repaired& r) {
  say("note", summary_of(r.defects));
  if (r.wrapped_sheets)
    say("note", "most of it is sheets without an inside: they are wrapped, one voxel outside (--hull outer: not)");
  if (r.filled_holes == 0) return;
  std::string text = fmt::format("{} {} filled", r.filled_holes, r.filled_holes == 1 ? "hole" : "holes");
  if (const auto& hole = r.largest_hole)
    text +=
        fmt::format(", the largest {:.4g} across at ({:.4g}, {:.4g}, {:.4g}); 'mesh --method shell' keeps holes open",
                    hole->size, hole->middle.x, hole->middle.y, hole->middle.z);
  say("note", text);
}

int run_repair(const RepairArguments& a) {
  Operation operation{.options = {{"hull", a.hull}}};
  operation.prepare = [hull = choice<Hull>("--hull", a.hull)](Shape& shape, MeshOptions& options, Talk talk,
                                                              ExecutionContext& context) {
    Repaired result = repaired(shape, hull, options, context);
    if (talk != Talk::quiet) tell(result);
    shape = std::move(result.shape);
    options = std::move(result.options);
  };
  return run_meshing(a.meshing, operation);
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
      ->add_option(
          "--hull", a->hull,
          "what becomes the solid: " + joined_names<Hull>("|") +
              ". outer: all that the outside does not reach,\n"
              "cavities and inner shells are filled; oriented: so, but parts that face inward bound nothing;\n"
              "all: inner shells are kept; wrap: a closed mesh one voxel outside; auto: wrap for open sheets,\n"
              "else outer")
      ->type_name("HULL");
  add_meshing_options(*command, a->meshing);
  command->callback([a, &action] { action = [a] { return run_repair(*a); }; });
}

}  // namespace evenmesh::cli
