/// evenmesh compare: how far two meshes are from each other.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "command.h"
#include "evenmesh/measure.h"
#include "input.h"
#include "interrupt.h"
#include "output.h"
#include "terminal.h"
#include "values.h"

namespace evenmesh::cli {
namespace {

struct CompareArguments {
  std::string a, b;
  std::string samples = "500000";
  std::string threads = "0";
  bool json = false;
};

std::string crease_line(const MeshDistance& d) {
  if (d.crease_length == 0) return "  B has no edges sharper than 40°\n";
  const std::string sharp = fmt::format("  edges of B sharper than 40°: {:.6g} long; ", d.crease_length);
  if (!std::isfinite(d.crease_max)) return sharp + "A has none above 20°\n";
  const double edge = d.edge_length_avg > 0 ? d.edge_length_avg : 1;
  return sharp + fmt::format(
                     "from them to those of A {:.6g} at most, {:.6g} on average\n  ({:.4f} and {:.4f} of A's mean "
                     "edge length)\n",
                     d.crease_max, d.crease_avg, d.crease_max / edge, d.crease_avg / edge);
}

std::string text(const MeshDistance& d) {
  const auto row = [&](const char* name, double there, double back) {
    const double both = std::max(there, back);
    const double diagonal = d.reference_diagonal;
    return fmt::format("  {:<12} {:>12.6g} {:>12.6g} {:>12.6g} {:>11.4f} %\n", name, there, back, both,
                       diagonal > 0 ? 100 * both / diagonal : 0.0);
  };
  return fmt::format("  {:<12} {:>12} {:>12} {:>12} {:>13}\n", "", "A to B", "B to A", "both", "of diagonal") +
         row("Hausdorff", d.a_to_b_max, d.b_to_a_max) + row("RMS", d.a_to_b_rms, d.b_to_a_rms) +
         row("mean", d.a_to_b_mean, d.b_to_a_mean) +
         fmt::format("  normals deviate by {:.2f}° on average; diagonal of B {:.6g}\n", d.normal_deviation_avg,
                     d.reference_diagonal) +
         crease_line(d);
}

std::string json(const MeshDistance& d) {
  const double diagonal = d.reference_diagonal;
  const double rms = std::max(d.a_to_b_rms, d.b_to_a_rms);
  const auto relative = [&](double length) { return diagonal > 0 ? length / diagonal : 0.0; };
  // JSON has no infinity.
  const auto finite = [](double x) { return std::isfinite(x) ? nlohmann::ordered_json(x) : nullptr; };
  const nlohmann::ordered_json object{{"hausdorff", d.hausdorff()},
                                      {"hausdorff_relative", relative(d.hausdorff())},
                                      {"rms", rms},
                                      {"rms_relative", relative(rms)},
                                      {"a_to_b_max", d.a_to_b_max},
                                      {"b_to_a_max", d.b_to_a_max},
                                      {"a_to_b_rms", d.a_to_b_rms},
                                      {"b_to_a_rms", d.b_to_a_rms},
                                      {"a_to_b_mean", d.a_to_b_mean},
                                      {"b_to_a_mean", d.b_to_a_mean},
                                      {"normal_deviation_avg", d.normal_deviation_avg},
                                      {"reference_diagonal", diagonal},
                                      {"crease_max", finite(d.crease_max)},
                                      {"crease_avg", finite(d.crease_avg)},
                                      {"crease_length", d.crease_length},
                                      {"edge_length_avg", d.edge_length_avg}};
  return object.dump(2) + "\n";
}

/// Brings a mesh to the unit of the reference, where both are known.
void convert(Mesh& mesh, const Mesh& reference, const std::string& name) {
  if (!mesh.unit || !reference.unit || mesh.unit == reference.unit) return;
  const double factor = conversion_factor(*mesh.unit, *reference.unit);
  for (Vec3& v : mesh.vertices) v *= factor;
  say("note",
      fmt::format("{} is converted from {} to the {} of B", name, plural_of(*mesh.unit), plural_of(*reference.unit)));
  mesh.unit = reference.unit;
}

int run_compare(const CompareArguments& a) {
  const CompareOptions options{.samples = whole_number("--samples", a.samples, 1, 1'000'000'000)};
  if (a.a == "-" && a.b == "-") throw InvalidInput("only one of the two meshes can come from standard input");
  ExecutionContext context(static_cast<unsigned>(whole_number("-j", a.threads, 0, 1024)));
  const CancelOnInterrupt interrupt(context);
  Mesh first = read_mesh_file("compare", a.a, context);
  const Mesh second = read_mesh_file("compare", a.b, context);
  convert(first, second, a.a);
  const MeshDistance distance = compare_meshes(first, second, options, context);
  write_output("-", a.json ? json(distance) : text(distance));
  return Status::done;
}

}  // namespace

void add_compare_command(CLI::App& app, Action& action) {
  const auto a = std::make_shared<CompareArguments>();
  CLI::App* command =
      app.add_subcommand("compare", "two-sided Hausdorff distance, RMS and normal deviation of two meshes");
  command->add_option("A", a->a, "mesh file, or - for standard input")->type_name("")->required();
  command->add_option("B", a->b, "reference mesh: its diagonal is the unit of relative figures")
      ->type_name("")
      ->required();
  command->add_option("--samples", a->samples, "points spread over each mesh, 1 to 1000000000; default 500000")
      ->type_name("N");
  command->add_flag("--json", a->json, "print one JSON object instead");
  command->add_option("-j,--threads", a->threads, "number of threads, 0 to 1024; default 0 = one per processor")
      ->type_name("N");
  command->callback([a, &action] { action = [a] { return run_compare(*a); }; });
}

}  // namespace evenmesh::cli
