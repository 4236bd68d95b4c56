/// evenmesh info: what a mesh, or a point cloud, is like.

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <variant>

#include "command.h"
#include "evenmesh/measure.h"
#include "evenmesh/points.h"
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

using Json = nlohmann::ordered_json;

std::string describe(const Mesh& mesh, bool json, ExecutionContext& context) {
  const MeshQuality quality = measure_quality(mesh, context);
  const std::size_t pairs = self_intersections(mesh, context).size();
  if (!json) return table(quality, pairs, mesh.unit);
  auto figures = Json::parse(quality_json(quality));
  figures["self_intersections"] = pairs;
  if (mesh.unit) figures["unit"] = abbreviation_of(*mesh.unit);
  return figures.dump(2) + "\n";
}

std::string describe(const PointCloud& cloud, bool json, ExecutionContext& context) {
  const double spacing = point_spacing(cloud, context);
  if (!json) return table(cloud, spacing);
  const Box box = cloud.bounds();
  const Json figures{{"points", cloud.points.size()},
                     {"normals", !cloud.normals.empty()},
                     {"spacing", spacing},
                     {"bounds", {box.lo.x, box.lo.y, box.lo.z, box.hi.x, box.hi.y, box.hi.z}}};
  return figures.dump(2) + "\n";
}

int run_info(const InfoArguments& a) {
  ExecutionContext context(static_cast<unsigned>(whole_number("-j", a.threads, 0, 1024)));
  const CancelOnInterrupt interrupt(context);
  const std::variant<Mesh, PointCloud> contents = read_file("info", a.mesh, context);
  const std::string text = std::visit([&](const auto& what) { return describe(what, a.json, context); }, contents);
  write_output("-", a.json ? text : fmt::format("{}\n{}", a.mesh == "-" ? "standard input" : a.mesh, text));
  return Status::done;
}

}  // namespace

void add_info_command(CLI::App& app, Action& action) {
  const auto a = std::make_shared<InfoArguments>();
  CLI::App* command =
      app.add_subcommand("info", "size, quality and topology of a mesh, or size and spacing of points, as a table");
  command->add_option("MESH", a->mesh, "mesh or point file, or - for standard input")->type_name("")->required();
  command->add_flag("--json", a->json, "print one JSON object instead");
  command->add_option("-j,--threads", a->threads, "number of threads, 0 to 1024; default 0 = one per processor")
      ->type_name("N");
  command->callback([a, &action] { action = [a] { return run_info(*a); }; });
}

}  // namespace evenmesh::cli
