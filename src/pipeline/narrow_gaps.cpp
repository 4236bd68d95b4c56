#include <algorithm>
#include <cmath>
#include <string>

#include "band/enclosed.h"
#include "pipeline/sampling.h"

namespace evenmesh {
namespace {

constexpr double gap_per_edge = 0.9;
constexpr double worth_filling = 0.05;  ///< share of the area

}  // namespace

bool fill_narrow_gaps(Sampling& sampling, const std::string& cure, ExecutionContext& context) {
  SampleSet& samples = sampling.samples;
  std::erase_if(sampling.findings, [](const Finding& f) { return f.code == FindingCode::narrow_gaps_filled; });
  if (samples.size() == 0) return false;
  const double h = samples.grid.spacing, area = samples.total_area;
  if (sampling.gap == 0)
    sampling.gap = gap_per_edge * edge_length_of(area, static_cast<double>(sampling.plan.vertices));
  const auto reach = static_cast<unsigned>(std::clamp(std::round(0.5 * sampling.gap / h), 1.0, 10.0));
  SampleSet filled = narrow_gaps_filled(samples, reach, context);
  const double hidden = area - filled.total_area;
  sampling.hidden_area = hidden >= worth_filling * area ? hidden : 0;
  if (sampling.hidden_area == 0) return false;
  sampling.findings.push_back(
      make_finding(FindingCode::narrow_gaps_filled, {{"gap", 2 * reach * h}, {"area", hidden}, {"cure", cure}}));
  samples = std::move(filled);
  return true;
}

}  // namespace evenmesh
