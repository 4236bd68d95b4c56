/// evenmesh info: what a mesh is like.

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "command.h"
#include "evenmesh/measure.h"
#include "input.h"
#include "interrupt.h"
#include "output.h"
#include "summary.h"
#include "values.h"

namespace evenmesh::cli {
namespace {

struct InfoArguments {
  std::string mesh, threads = "0";
  bool json = false;
};

int run_info(const InfoArguments& a) {
  Run run(static_cast<unsigned>(whole_number("-j", a.threads, 0, 1024)));
  const CancelOnInterrupt interrupt(run);
  const Mesh mesh = read_mesh_file("info", a.mesh, run);
  const MeshQuality quality = measure_quality(mesh, run);
  const std::size_t pairs = self_intersections(mesh, run).size();
  if (!a.json) {
    write_output("-", fmt::format("{}\n{}", a.mesh == "-" ? "standard input" : a.mesh, table(quality, pairs)));
    return Status::done;
  }
  auto json = nlohmann::ordered_json::parse(quality_json(quality));
  json["self_intersections"] = pairs;
  write_output("-", json.dump(2) + "\n");
  return Status::done;
}

}  // namespace

void add_info_command(CLI::App& app, Action& action) {
  const auto a = std::make_shared<InfoArguments>();
  CLI::App* command = app.add_subcommand("info", "size, quality and topology of a mesh, as a table");
  command->add_option("MESH", a->mesh, "mesh file, or - for standard input")->type_name("")->required();
  command->add_flag("--json", a->json, "print one JSON object instead");
  command->add_option("-j,--threads", a->threads, "number of threads, 0 to 1024; default 0 = one per processor")
      ->type_name("N");
  command->callback([a, &action] { action = [a] { return run_info(*a); }; });
}

}  // namespace evenmesh::cli
