#include "evenmesh/written.h"

#include <algorithm>

#include "evenmesh/findings.h"
#include "evenmesh/measure.h"
#include "geometry/single_precision.h"

namespace evenmesh {
namespace {

void measure_again(MeshResult& result, ExecutionContext& context) {
  Report& report = result.report;
  report.quality = measure_quality(result.mesh, context);
  report.self_intersections = self_intersections(result.mesh, context).size();
  std::erase_if(report.findings, [](const Finding& finding) {
    return finding.code == FindingCode::self_intersections || finding.code == FindingCode::no_area;
  });
  const auto say = [&](FindingCode code, std::size_t count) {
    if (count > 0)
      report.findings.push_back(make_finding(code, {{"count", static_cast<double>(count)}, {"where", std::string()}}));
  };
  say(FindingCode::self_intersections, report.self_intersections);
  say(FindingCode::no_area, report.quality.degenerate_faces);
}

}  // namespace

MeshResult as_written(MeshResult result, MeshFormat format, ExecutionContext& context) {
  const double in_single = displacement(result.mesh, in_single_precision(result.mesh.vertices));
  if (in_single <= single_precision_error) return result;
  std::vector<Finding>& findings = result.report.findings;
  if (format == MeshFormat::stl) findings.push_back(make_finding(FindingCode::stl_as_text, {{"edges", in_single}}));
  std::vector<Vec3> stored = stored_vertices(result.mesh, format);
  const double edges = displacement(result.mesh, stored);
  if (edges <= single_precision_error) return result;
  result.mesh.vertices = std::move(stored);
  measure_again(result, context);
  findings.push_back(make_finding(FindingCode::coordinates_rounded, {{"edges", edges}}));
  return result;
}

}  // namespace evenmesh
