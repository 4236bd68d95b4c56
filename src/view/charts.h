#pragma once
/// Small charts as inline SVG; colours come from the page's CSS variables, so that they follow its light or dark theme.

#include <string>
#include <utility>
#include <vector>

#include "evenmesh/measure.h"

namespace evenmesh {

/// Text with the characters escaped that mean something in HTML and in quoted attributes.
std::string escape_html(std::string_view text);

/// Bars over the bins; the axis is labelled at `ticks` equal steps, with `unit` behind the numbers.
/// @param ideal  where the best value lies: marked by a line
std::string histogram_svg(const Histogram& histogram, const std::string& label, const std::string& unit, int ticks,
                          double ideal);

/// The energy ratio (1 = perfect) over the evaluations, its excess over 1 on a logarithmic scale. Empty without values.
std::string energy_svg(const std::vector<double>& ratios);

/// Wall time per stage, as shares of one bar, with a legend.
std::string time_bar_html(const std::vector<std::pair<std::string, double>>& seconds);

}  // namespace evenmesh
