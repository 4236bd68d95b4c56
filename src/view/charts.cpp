#include "view/charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace evenmesh {
namespace {

constexpr double width = 440, height = 220, left = 52, right = 18, top = 14, bottom = 32;
constexpr double plot_width = width - left - right, plot_height = height - top - bottom, floor_y = top + plot_height;

std::string svg_begin(const std::string& label) {
  return fmt::format("<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">", width, height, escape_html(label));
}

std::string line(double x1, double y1, double x2, double y2, const char* css) {
  return fmt::format("<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>", css, x1, y1, x2,
                     y2);
}

std::string text(double x, double y, const char* anchor, const std::string& content) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>", x, y, anchor,
                     escape_html(content));
}

/// Evaluations may be many; a curve needs no more points than the picture has columns.
std::vector<std::size_t> spread_indices(std::size_t count) {
  const std::size_t most = 600;
  std::vector<std::size_t> indices;
  const std::size_t points = std::min(count, most);
  for (std::size_t i = 0; i < points; ++i) indices.push_back(points < 2 ? 0 : i * (count - 1) / (points - 1));
  return indices;
}

/// Where excess energy (ratio − 1) stands on the logarithmic axis, 0 at the bottom, 1 at the top.
struct EnergyAxis {
  double lo = 1e-3, hi = 1;  ///< powers of ten, or halves of them

  explicit EnergyAxis(const std::vector<double>& ratios) {
    double least = 1, most = 2e-3;  // of the excess
    for (const double r : ratios)
      if (std::isfinite(r)) {
        least = std::min(least, std::max(r - 1, 1e-4));
        most = std::max(most, r - 1);
      }
    lo = std::pow(10, std::floor(std::log10(least)));
    hi = std::pow(10, std::ceil(std::log10(most)));
    if (least > 3 * lo) lo *= 3;
    if (most < hi / 3.4) hi /= 3;
  }
  double operator()(double ratio) const {
    return std::clamp(std::log(std::max(ratio - 1, lo) / lo) / std::log(hi / lo), 0.0, 1.0);
  }
};

std::string energy_grid(const EnergyAxis& axis) {
  std::string svg;
  for (double decade = 1e-4; decade < 1e4; decade *= 10)
    for (const double step : {1.0, 2.0, 5.0}) {
      const double excess = decade * step;
      if (excess < axis.lo * 0.999 || excess > axis.hi * 1.001) continue;
      const double y = floor_y - axis(1 + excess) * plot_height;
      svg += line(left, y, width - right, y, "grid") + text(left - 6, y + 4, "end", fmt::format("{:.4g}", 1 + excess));
    }
  return svg;
}

constexpr std::array<const char*, 8> stage_colours = {"#3d7bd9", "#2f9e62", "#e0a030", "#c8502f",
                                                      "#8e5bc0", "#35a7b5", "#b0577f", "#7d8794"};

}  // namespace

std::string escape_html(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string histogram_svg(const Histogram& histogram, const std::string& label, const std::string& unit, int ticks,
                          double ideal) {
  std::size_t total = 0, most = 1;
  for (const std::size_t c : histogram.counts) {
    total += c;
    most = std::max(most, c);
  }
  std::string svg = svg_begin(label);
  const double bar = plot_width / static_cast<double>(histogram.counts.size());
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    const std::size_t n = histogram.counts[i];
    if (n == 0) continue;
    // What is rare must still be seen: it is what one looks for.
    const double h = std::max(1.0, plot_height * static_cast<double>(n) / static_cast<double>(most));
    const double bin = (histogram.hi - histogram.lo) / static_cast<double>(histogram.counts.size());
    svg += fmt::format(
        "<rect class=\"bar\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"><title>{:.4g}–{:.4g}{}: {} "
        "({:.2f} %)</title></rect>",
        left + bar * static_cast<double>(i) + 0.5, floor_y - h, std::max(0.5, bar - 1), h,
        histogram.lo + bin * static_cast<double>(i), histogram.lo + bin * static_cast<double>(i + 1), unit, n,
        100.0 * static_cast<double>(n) / static_cast<double>(std::max<std::size_t>(total, 1)));
  }
  svg += line(left, floor_y, width - right, floor_y, "axis");
  const double at = left + plot_width * (ideal - histogram.lo) / (histogram.hi - histogram.lo);
  svg += line(at, top, at, floor_y, "ideal");
  for (int i = 0; i <= ticks; ++i) {
    const double share = static_cast<double>(i) / ticks, value = histogram.lo + share * (histogram.hi - histogram.lo);
    svg += text(left + share * plot_width, floor_y + 18, "middle", fmt::format("{:.4g}{}", value, unit));
  }
  const double peak = 100.0 * static_cast<double>(most) / static_cast<double>(std::max<std::size_t>(total, 1));
  svg += text(left - 6, top + 10, "end", fmt::format("{:.3g} %", peak)) + text(left - 6, floor_y, "end", "0");
  return svg + "</svg>";
}

std::string energy_svg(const std::vector<double>& ratios) {
  if (ratios.empty()) return {};
  const EnergyAxis axis(ratios);
  std::string svg = svg_begin("energy ratio per evaluation") + energy_grid(axis), points;
  const auto last = static_cast<double>(std::max<std::size_t>(ratios.size() - 1, 1));
  for (const std::size_t i : spread_indices(ratios.size())) {
    if (!std::isfinite(ratios[i])) continue;
    points += fmt::format("{:.1f},{:.1f} ", left + plot_width * static_cast<double>(i) / last,
                          floor_y - axis(ratios[i]) * plot_height);
  }
  svg += "<polyline class=\"curve\" points=\"" + points + "\"/>";
  svg += line(left, floor_y, width - right, floor_y, "axis");
  svg += text(left, floor_y + 18, "middle", "1");
  svg += text(width - right, floor_y + 18, "end", fmt::format("{} evaluations", ratios.size()));
  return svg + "</svg>";
}

std::string time_bar_html(const std::vector<std::pair<std::string, double>>& seconds) {
  double total = 0;
  for (const auto& [stage, s] : seconds) total += s;
  if (!(total > 0)) return {};
  std::string bar, legend;
  for (std::size_t i = 0; i < seconds.size(); ++i) {
    const auto& [stage, s] = seconds[i];
    const char* colour = stage_colours[i % stage_colours.size()];
    const std::string name = escape_html(stage);
    bar += fmt::format("<span style=\"width:{:.3f}%;background:{}\" title=\"{}: {:.3f} s\"></span>", 100 * s / total,
                       colour, name, s);
    legend += fmt::format("<li><i style=\"background:{}\"></i>{} <b>{:.3f} s</b> <small>{:.1f} %</small></li>", colour,
                          name, s, 100 * s / total);
  }
  return "<div class=\"time\">" + bar + "</div><ul class=\"legend\">" + legend + "</ul>";
}

}  // namespace evenmesh
