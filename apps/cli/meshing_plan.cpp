/// From texts of options to values, and back to JSON.

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "evenmesh/options_json.h"
#include "meshing.h"
#include "values.h"

namespace evenmesh::cli {
namespace {

using Json = nlohmann::ordered_json;

/// Options that are documented but not built yet: never silently ignored.
void refuse_planned_options(const MeshingArguments& a) {
  if (!a.error.empty()) not_available("--error");
  if (a.density == "curvature" || std::filesystem::exists(a.density)) not_available("--density " + a.density);
}

/// Degrees; none: off.
std::optional<double> feature_angle(const std::string& text) {
  if (text == "off") return std::nullopt;
  if (text == "auto") return MeshOptions{}.feature_angle;
  const double angle = real_number("--features", text, 0, 180);
  if (!(angle > 0 && angle < 180))
    throw InvalidInput(fmt::format("--features takes auto, off or an angle between 0 and 180 degrees, not {}", text));
  return angle;
}

MeshOptions mesh_options(const MeshingArguments& a) {
  MeshOptions options;
  if (!a.vertices.empty() && !a.edge_length.empty()) {
    throw InvalidInput("-n and -l both say how fine the mesh is; give one of them");
  }
  if (!a.vertices.empty()) options.vertices = whole_number("-n", a.vertices, ranges::vertices);
  if (!a.edge_length.empty()) {
    options.edge_length = real_number("-l", a.edge_length);
    if (!(*options.edge_length > 0)) {
      throw InvalidInput(fmt::format("-l takes a length above 0; {} is out of range", a.edge_length));
    }
  }
  if (!a.resolution.empty()) options.resolution = whole_number("-r", a.resolution, ranges::resolution);
  if (!a.bounds.empty()) options.bounds = box("--bounds", a.bounds);
  options.method = choice<Method>("--method", a.method);
  options.wrap = a.wrap;
  options.feature_angle = feature_angle(a.features);
  if (!a.thickness.empty()) options.thickness = whole_number("--thickness", a.thickness, ranges::thickness);
  options.quality = choice<Quality>("--quality", a.quality);
  options.optimizer = choice<Optimizer>("--optimizer", a.optimizer);
  options.start = choice<Start>("--start", a.start);
  options.connect = choice<Connect>("--connect", a.connect);
  if (!a.max_cycle.empty()) {
    options.max_cycle = whole_number("--max-cycle", a.max_cycle, ranges::max_cycle);
    if (options.connect != Connect::fragments)
      throw InvalidInput("--max-cycle is for --connect fragments; give both or neither");
  }
  options.topology = choice<TopologyRule>("--topology", a.topology);
  options.placement = choice<Placement>("--placement", a.placement);
  if (!a.iterations.empty()) options.iterations = whole_number("--iterations", a.iterations, ranges::iterations);
  if (!a.tolerance.empty()) {
    options.tolerance = real_number("--tolerance", a.tolerance);
    if (!(options.tolerance > 0 && options.tolerance < 1)) {
      throw InvalidInput(
          fmt::format("--tolerance takes a number above 0 and below 1; {} is out of range", a.tolerance));
    }
  }
  if (!a.evenness.empty()) {
    options.evenness = real_number("--evenness", a.evenness);
    if (!(options.evenness >= 0 && options.evenness <= 1))
      throw InvalidInput(fmt::format("--evenness takes a number from 0 to 1; {} is out of range", a.evenness));
  }
  if (a.density != "uniform") options.density = density_from_expression(a.density, parameters_of(a.input));
  options.seed = whole_number("--seed", a.seed, 0);
  return options;
}

void read_input_options(MeshingArguments& a) {
  for (const std::string& text : a.definitions) a.input.options.definitions.insert(definition("-D", text));
  if (!a.raster_vertices.empty())
    a.input.raster_vertices = whole_number("--raster-vertices", a.raster_vertices, 3, 2'147'483'647);
  a.input.density = a.density != "uniform";
  a.input.options.entry = a.entry;
  a.input.options.device = a.gl_device;
  if (!a.lipschitz.empty()) {
    a.input.options.lipschitz = real_number("--lipschitz", a.lipschitz);
    if (!(*a.input.options.lipschitz > 0)) throw InvalidInput("--lipschitz takes a number above 0; a distance has 1");
  }
  if (!a.level.empty()) a.input.options.level = real_number("--level", a.level);
}

/// What was read.
void add_inputs(const MeshingArguments& a, const Operation& operation, Json& json) {
  if (operation.inputs.most > 1) {
    json["inputs"] = a.input.positional;
    json["expressions"] = a.input.expressions;
  } else if (!a.input.positional.empty()) {
    json["input"] = a.input.positional[0];
  } else if (a.input.raster.empty()) {
    json["expression"] = a.input.expressions.at(0);
  }
  const InputOptions& options = a.input.options;
  if (!a.input.raster.empty()) json["raster"] = a.input.raster;
  if (a.input.raster_vertices != 0) json["raster_vertices"] = a.input.raster_vertices;
  for (const auto& [name, value] : options.definitions) json["parameters"][name] = value;
  if (options.entry != InputOptions{}.entry) json["entry"] = options.entry;
  if (options.lipschitz) json["lipschitz"] = *options.lipschitz;
  if (!a.level.empty()) json["level"] = options.level;
}

/// The options of the library (options_json.h) and those of the program around them.
Json options_of_run(const MeshingArguments& a, const Operation& operation, const Plan& plan) {
  Json json = Json::object();
  add_inputs(a, operation, json);
  for (const auto& [name, value] : operation.options) json[name] = value;
  json["output"] = a.output;
  json.update(Json::parse(options_json(plan.options)));
  if (plan.outliers) json["outliers"] = *plan.outliers;
  if (plan.regularize) json["regularize"] = {a.regularize[0], *plan.regularize};
  if (plan.unit) json["unit"] = abbreviation_of(*plan.unit);
  json["backend"] = a.backend;
  json["threads"] = plan.threads;
  return json;
}

}  // namespace

int outputs_to_standard_output(const MeshingArguments& a) {
  return (a.output == "-") + (a.json == "-") + (a.report == "-") + (a.dump_shell == "-") + (a.dump_dexels == "-");
}

Plan check(MeshingArguments& a, const Operation& operation) {
  read_input_options(a);
  check_input(a.input, operation.inputs);
  refuse_planned_options(a);
  Plan plan;
  plan.options = mesh_options(a);
  a.input.options.bounds = plan.options.bounds.value_or(Box{});
  if (!a.outliers.empty()) plan.outliers = real_number("--outliers", a.outliers, 0, 100);
  if (!a.regularize.empty()) {
    choice("--regularize", a.regularize[0], {"global"});
    plan.regularize = real_number("--regularize global", a.regularize[1]);
    if (!(*plan.regularize > 0)) throw InvalidInput("--regularize global takes a radius above 0");
  }
  if (!a.unit.empty()) {
    plan.unit = unit_of_name(a.unit);
    if (!plan.unit) throw InvalidInput(fmt::format("--unit takes one of {}, not '{}'", unit_names(), a.unit));
  }
  plan.threads = static_cast<unsigned>(whole_number("-j", a.threads, 0, 1024));
  choice("--progress", a.progress, {"auto", "on", "off"});
  plan.on_gl = choice("--backend", a.backend, {"cpu", "gl"}) == 1;
  if (a.quiet && a.verbose) throw InvalidInput("-q and -v contradict each other; give one of them");
  plan.talk = a.quiet ? Talk::quiet : a.verbose ? Talk::verbose : Talk::normal;
  plan.output = check_mesh_output(a.output, a.format);
  if (!a.report.empty()) check_output("--report", a.report);
  if (!a.json.empty()) check_output("--json", a.json);
  if (!a.dump_shell.empty()) {
    check_output("--dump-shell", a.dump_shell);
    require_vdb();
  }
  if (!a.dump_dexels.empty()) check_output("--dump-dexels", a.dump_dexels);
  if (outputs_to_standard_output(a) > 1) {
    throw InvalidInput("only one of -o, --json, --report, --dump-shell and --dump-dexels can go to standard output");
  }
  return plan;
}

std::string run_json(const MeshResult& result, const MeshingArguments& a, const Operation& operation,
                     const Plan& plan) {
  Json json = Json::parse(report_json(result.report));
  if (result.mesh.unit) json["unit"] = abbreviation_of(*result.mesh.unit);
  json["version"] = EVENMESH_VERSION;
  json["options"] = options_of_run(a, operation, plan);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace evenmesh::cli
