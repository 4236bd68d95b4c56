#include "meshing.h"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "command.h"
#include "evenmesh/glsl.h"
#include "evenmesh/io.h"
#include "evenmesh/render.h"
#include "evenmesh/solid.h"
#include "interrupt.h"
#include "output.h"
#include "summary.h"
#include "terminal.h"
#include "values.h"

namespace evenmesh::cli {
namespace {

using Json = nlohmann::ordered_json;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

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
  if (!a.vertices.empty()) options.vertices = whole_number("-n", a.vertices, 4, 1'000'000'000);
  if (!a.edge_length.empty()) {
    options.edge_length = real_number("-l", a.edge_length);
    if (!(*options.edge_length > 0)) {
      throw InvalidInput(fmt::format("-l takes a length above 0; {} is out of range", a.edge_length));
    }
  }
  if (!a.resolution.empty()) options.resolution = whole_number("-r", a.resolution, 8, 8192);
  if (!a.bounds.empty()) options.bounds = box("--bounds", a.bounds);
  options.method = static_cast<Method>(choice("--method", a.method, {"auto", "raster", "shell"}));
  options.wrap = a.wrap;
  options.feature_angle = feature_angle(a.features);
  if (!a.thickness.empty()) options.thickness = static_cast<unsigned>(whole_number("--thickness", a.thickness, 1, 20));
  options.quality = static_cast<Quality>(choice("--quality", a.quality, {"fast", "normal", "high"}));
  options.optimizer = static_cast<Optimizer>(choice("--optimizer", a.optimizer, {"lbfgs", "lloyd"}));
  options.start = static_cast<Start>(choice("--start", a.start, {"random", "blue-noise", "coarse-to-fine"}));
  options.connect = static_cast<Connect>(choice("--connect", a.connect, {"complex", "flood", "fragments"}));
  if (!a.max_cycle.empty()) {
    options.max_cycle = whole_number("--max-cycle", a.max_cycle, 3, 8);
    if (options.connect != Connect::fragments)
      throw InvalidInput("--max-cycle is for --connect fragments; give both or neither");
  }
  options.topology = static_cast<TopologyRule>(choice("--topology", a.topology, {"keep", "simplify"}));
  options.placement =
      static_cast<Placement>(choice("--placement", a.placement, {"centroid", "constrained", "quadric"}));
  if (!a.iterations.empty()) options.iterations = whole_number("--iterations", a.iterations, 0, 10'000);
  if (!a.tolerance.empty()) {
    options.tolerance = real_number("--tolerance", a.tolerance);
    if (!(options.tolerance > 0 && options.tolerance < 1)) {
      throw InvalidInput(
          fmt::format("--tolerance takes a number above 0 and below 1; {} is out of range", a.tolerance));
    }
  }
  if (a.density != "uniform") options.density = density_from_expression(a.density, parameters_of(a.input));
  options.seed = whole_number("--seed", a.seed, 0);
  return options;
}

Json options_json(const MeshingArguments& a, const Operation& operation, unsigned threads) {
  Json json = Json::object();
  const auto given = [&](const char* key, const std::string& text) {
    if (!text.empty()) json[key] = text;
  };
  if (operation.inputs.most > 1) {
    json["inputs"] = a.input.positional;
    json["expressions"] = a.input.expressions;
  } else if (a.input.positional.empty() && a.input.raster.empty()) {
    given("expression", a.input.expressions.at(0));
  } else if (!a.input.positional.empty()) {
    given("input", a.input.positional[0]);
  }
  if (!a.input.raster.empty()) json["raster"] = a.input.raster;
  given("raster_vertices", a.raster_vertices);
  for (const auto& [name, value] : operation.options) json[name] = value;
  for (const auto& [name, value] : a.input.definitions) json["parameters"][name] = value;
  if (a.entry != "map") json["entry"] = a.entry;
  given("lipschitz", a.lipschitz);
  given("level", a.level);
  given("output", a.output);
  given("vertices", a.vertices);
  given("edge_length", a.edge_length);
  given("resolution", a.resolution);
  given("thickness", a.thickness);
  given("outliers", a.outliers);
  if (!a.regularize.empty()) json["regularize"] = a.regularize;
  given("bounds", a.bounds);
  given("quality", a.quality);
  given("method", a.method);
  given("optimizer", a.optimizer);
  given("iterations", a.iterations);
  given("tolerance", a.tolerance);
  given("start", a.start);
  given("seed", a.seed);
  given("placement", a.placement);
  given("connect", a.connect);
  given("max_cycle", a.max_cycle);
  given("topology", a.topology);
  given("features", a.features);
  given("density", a.density);
  given("backend", a.backend);
  json["threads"] = threads;
  return json;
}

std::string run_json(const Report& report, const MeshingArguments& a, const Operation& operation, unsigned threads) {
  Json json = Json::parse(report_json(report));
  json["version"] = EVENMESH_VERSION;
  json["options"] = options_json(a, operation, threads);
  return json.dump(2) + "\n";
}

/// What the checks of the command line leave to do.
struct Plan {
  MeshOptions options;
  std::optional<double> outliers;    ///< standard deviations
  std::optional<double> regularize;  ///< radius
  MeshOutput output;
  unsigned threads = 0;
  bool on_gl = false;  ///< expressions too
  Talk talk = Talk::normal;
};

void read_input_options(MeshingArguments& a) {
  for (const std::string& text : a.definitions) a.input.definitions.insert(definition("-D", text));
  if (!a.raster_vertices.empty())
    a.input.raster_vertices = whole_number("--raster-vertices", a.raster_vertices, 3, 2'147'483'647);
  a.input.entry = a.entry, a.input.gl_device = a.gl_device;
  if (!a.lipschitz.empty()) {
    a.input.lipschitz = real_number("--lipschitz", a.lipschitz);
    if (!(*a.input.lipschitz > 0)) throw InvalidInput("--lipschitz takes a number above 0; a distance has 1");
  }
  if (!a.level.empty()) a.input.level = real_number("--level", a.level);
}

Plan check(MeshingArguments& a, const Operation& operation) {
  read_input_options(a);
  check_input(a.input, operation.inputs);
  refuse_planned_options(a);
  Plan plan;
  plan.options = mesh_options(a);
  if (!a.outliers.empty()) plan.outliers = real_number("--outliers", a.outliers, 0, 100);
  if (!a.regularize.empty()) {
    choice("--regularize", a.regularize[0], {"global"});
    plan.regularize = real_number("--regularize global", a.regularize[1]);
    if (!(*plan.regularize > 0)) throw InvalidInput("--regularize global takes a radius above 0");
  }
  plan.threads = static_cast<unsigned>(whole_number("-j", a.threads, 0, 1024));
  choice("--progress", a.progress, {"auto", "on", "off"});
  plan.on_gl = choice("--backend", a.backend, {"cpu", "gl"}) == 1;
  if (a.quiet && a.verbose) throw InvalidInput("-q and -v contradict each other; give one of them");
  plan.talk = a.quiet ? Talk::quiet : a.verbose ? Talk::verbose : Talk::normal;
  plan.output = check_mesh_output(a.output, a.format);
  if (!a.report.empty()) check_output("--report", a.report);
  if (!a.json.empty()) check_output("--json", a.json);
  if (!a.dump_shell.empty()) check_output("--dump-shell", a.dump_shell);
  if (!a.dump_dexels.empty()) check_output("--dump-dexels", a.dump_dexels);
  if ((a.output == "-") + (a.json == "-") + (a.report == "-") + (a.dump_shell == "-") + (a.dump_dexels == "-") > 1) {
    throw InvalidInput("only one of -o, --json, --report, --dump-shell and --dump-dexels can go to standard output");
  }
  return plan;
}

/// The shape without points that lie far from all others.
Shape without_outliers(const Shape& shape, double deviations, Talk talk, ExecutionContext& context) {
  if (!shape.points()) throw InvalidInput("--outliers is for points; the input has a surface");
  const std::size_t given = shape.points()->points.size();
  PointCloud cloud = remove_outliers(*shape.points(), {.deviations = deviations}, context);
  if (talk != Talk::quiet) say("note", fmt::format("{} of {} points left out", given - cloud.points.size(), given));
  return shape_from_points(std::move(cloud), shape.name);
}

/// Expressions move to OpenGL; inputs that have none are said and left as they are.
void move_to_gl(std::vector<Shape>& shapes, const std::string& device, Talk talk) {
  bool any = false;
  for (Shape& shape : shapes) {
    shape = on_gl(shape, device);
    any = any || runs_on_gl(shape);
  }
  if (!any && talk != Talk::quiet)
    say("note", "--backend gl: the input has no expression and no shader; everything runs on the CPU");
}

bool tell_findings(const Report& report, Talk talk) {
  bool kept = true;
  for (const Finding& finding : report.findings) {
    const bool broken = finding.severity == Severity::broken_promise;
    kept = kept && !broken;
    if (broken) {
      say("promise not kept", finding.sentence);
    } else if (talk != Talk::quiet) {
      say(finding.severity == Severity::note ? "note" : "warning", finding.sentence);
    }
  }
  return kept;
}

}  // namespace

int run_meshing(MeshingArguments a, const Operation& operation) {
  const auto start = std::chrono::steady_clock::now();
  const Plan plan = check(a, operation);
  ExecutionContext context(plan.threads);
  const CancelOnInterrupt interrupt(context);
  MeshResult result;
  Artifacts kept;
  if (!a.dump_dexels.empty()) kept.dexels.emplace();
  if (!a.dump_shell.empty()) kept.shell.emplace();
  if (!a.report.empty()) kept.shell_cut.emplace();
  std::string html;
  double reading = 0;
  {
    Terminal terminal(context, plan.talk, a.progress);
    std::vector<Shape> inputs = read_shapes(a.input, plan.options.bounds.value_or(Box{}), context);
    if (plan.on_gl) move_to_gl(inputs, a.input.gl_device, plan.talk);
    Shape shape = operation.combine ? operation.combine(std::move(inputs)) : std::move(inputs.at(0));
    if (plan.outliers) shape = without_outliers(shape, *plan.outliers, plan.talk, context);
    if (plan.regularize) shape = opening(closing(std::move(shape), *plan.regularize), *plan.regularize);
    MeshOptions options = plan.options;
    if (operation.prepare) operation.prepare(shape, options, plan.talk);
    reading = seconds_since(start);
    result = mesh_shape(shape, options, context, &kept);
    auto& seconds = result.report.seconds;
    seconds.insert(seconds.begin(), {"read", reading});
    if (!a.dump_shell.empty() && !kept.shell)
      throw InvalidInput("--dump-shell: rays have no shell; add --method shell");
    if (!a.dump_dexels.empty() && !kept.dexels)
      throw InvalidInput("--dump-dexels: sheets have no inside; add --method raster");
    if (!a.report.empty()) html = report_html(result, shape.name, context, kept);
  }
  {
    const WritingGuard guard;
    const auto writing = std::chrono::steady_clock::now();
    write_output(plan.output, result.mesh);
    result.report.seconds.emplace_back("write", seconds_since(writing));
    if (!a.report.empty()) write_output(a.report, html);
    if (!a.dump_shell.empty()) write_output(a.dump_shell, serialize_vdb(*kept.shell));
    if (!a.dump_dexels.empty()) write_output(a.dump_dexels, serialize_dexels(*kept.dexels));
    if (!a.json.empty()) write_output(a.json, run_json(result.report, a, operation, plan.threads));
  }
  const bool promises_kept = tell_findings(result.report, plan.talk);
  if (plan.talk != Talk::quiet) {
    const bool stdout_taken =
        a.output == "-" || a.json == "-" || a.report == "-" || a.dump_shell == "-" || a.dump_dexels == "-";
    fmt::print(stdout_taken ? stderr : stdout, "{}", summary(result.report, a.output, seconds_since(start)));
  }
  return promises_kept ? Status::done : Status::promise_broken;
}

}  // namespace evenmesh::cli
