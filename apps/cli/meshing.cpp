#include "meshing.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "command.h"
#include "evenmesh/glsl.h"
#include "evenmesh/io.h"
#include "evenmesh/render.h"
#include "evenmesh/solid.h"
#include "evenmesh/written.h"
#include "interrupt.h"
#include "summary.h"

namespace evenmesh::cli {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The shape without points that lie far from all others.
Shape without_outliers(const Shape& shape, double deviations, Talk talk, ExecutionContext& context) {
  if (!shape.points()) throw InvalidInput("--outliers is for points; the input has a surface");
  const std::size_t given = shape.points()->points.size();
  PointCloud cloud = remove_outliers(*shape.points(), {.deviations = deviations}, context);
  if (talk != Talk::quiet) say("note", fmt::format("{} of {} points left out", given - cloud.points.size(), given));
  Shape rest = shape_from_points(std::move(cloud), shape.name);
  rest.unit = shape.unit;
  rest.findings = shape.findings;
  return rest;
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
    if (broken || talk != Talk::quiet) say(finding);
  }
  return kept;
}

/// What is kept beside the mesh, as asked for.
Artifacts asked_for(const MeshingArguments& a) {
  Artifacts kept;
  if (!a.dump_dexels.empty()) kept.dexels.emplace();
  if (!a.dump_shell.empty()) kept.shell.emplace();
  if (!a.report.empty()) kept.shell_cut.emplace();
  return kept;
}

/// What is meshed; operations may change the options, once the shape is known.
Shape make_shape(const MeshingArguments& a, const Operation& operation, const Plan& plan, MeshOptions& options,
                 ExecutionContext& context) {
  std::vector<Shape> shapes = in_one_unit(read_shapes(a.input, context), plan.unit);
  if (plan.on_gl) move_to_gl(shapes, a.input.options.device, plan.talk);
  Shape shape = operation.combine ? operation.combine(std::move(shapes)) : std::move(shapes.at(0));
  if (plan.outliers) shape = without_outliers(shape, *plan.outliers, plan.talk, context);
  if (plan.regularize) shape = opening(closing(std::move(shape), *plan.regularize), *plan.regularize);
  if (operation.prepare) operation.prepare(shape, options, plan.talk, context);
  return shape;
}

void require_kept(const MeshingArguments& a, const Artifacts& kept) {
  if (!a.dump_shell.empty() && !kept.shell) throw InvalidInput("--dump-shell: rays have no shell; add --method shell");
  if (!a.dump_dexels.empty() && !kept.dexels)
    throw InvalidInput("--dump-dexels: sheets have no inside; add --method raster");
}

/// All files, or none.
void write_all(const MeshingArguments& a, const Operation& operation, const Plan& plan, MeshResult& result,
               const Artifacts& kept, const std::string& html) {
  const WritingGuard guard;
  const auto start = std::chrono::steady_clock::now();
  write_output(plan.output, result.mesh);
  result.report.seconds.emplace_back("write", seconds_since(start));
  if (!a.report.empty()) write_output(a.report, html);
  if (!a.dump_shell.empty()) write_output(a.dump_shell, serialize_vdb(*kept.shell));
  if (!a.dump_dexels.empty()) write_output(a.dump_dexels, serialize_dexels(*kept.dexels));
  if (!a.json.empty()) write_output(a.json, run_json(result, a, operation, plan));
}

}  // namespace

int run_meshing(MeshingArguments a, const Operation& operation) {
  const auto start = std::chrono::steady_clock::now();
  const Plan plan = check(a, operation);
  ExecutionContext context(plan.threads);
  const CancelOnInterrupt interrupt(context);
  MeshResult result;
  Artifacts kept = asked_for(a);
  std::string html;
  {
    const Terminal terminal(context, plan.talk, a.progress);
    MeshOptions options = plan.options;
    const Shape shape = make_shape(a, operation, plan, options, context);
    const double reading = seconds_since(start);
    result = as_written(mesh_shape(shape, options, context, &kept), plan.output.format, context);
    auto& seconds = result.report.seconds;
    seconds.insert(seconds.begin(), {"read", reading});
    require_kept(a, kept);
    // Who names a unit knows which one the file is in.
    const std::optional<Finding> remark = unit_remark(result.mesh, plan.output.format);
    if (remark && !(plan.unit && remark->code == FindingCode::unit_lost)) result.report.findings.push_back(*remark);
    if (!a.report.empty()) html = report_html(result, shape.name, context, kept);
  }
  write_all(a, operation, plan, result, kept, html);
  const bool promises_kept = tell_findings(result.report, plan.talk);
  if (plan.talk != Talk::quiet) {
    const std::string text = summary(result.report, a.output, seconds_since(start));
    fmt::print(outputs_to_standard_output(a) > 0 ? stderr : stdout, "{}", text);
  }
  return promises_kept ? Status::done : Status::promise_broken;
}

}  // namespace evenmesh::cli
