#include <fmt/format.h>

#include <cmath>

#include "evenmesh/render.h"
#include "view/base64.h"
#include "view/charts.h"
#include "view/lit_mesh.h"
#include "view/shell_cut.h"

namespace evenmesh {
namespace {

constexpr const char* style = R"(<style>
:root{color-scheme:light dark;--page:#f4f6f8;--card:#fff;--text:#1c242e;--soft:#5d6875;--line:#dde3ea;--bar:#3d7bd9;--ideal:#2f9e62;--bad:#b3261e;--bad-bg:#fdecea;--note:#8a5a00;--note-bg:#fff6e0;--good:#1d7a46}
@media(prefers-color-scheme:dark){:root{--page:#12161b;--card:#1b2129;--text:#e6ebf1;--soft:#95a1af;--line:#2d3641;--bar:#6ea3f0;--ideal:#5cc98d;--bad:#ff9d94;--bad-bg:#3a1d1b;--note:#f0c674;--note-bg:#33291a;--good:#5cc98d}}
*{box-sizing:border-box}
body{margin:0;background:var(--page);color:var(--text);font:15px/1.5 system-ui,-apple-system,"Segoe UI",Roboto,"Helvetica Neue",sans-serif}
main{max-width:1240px;margin:0 auto;padding:28px 20px 48px}
h1{font-size:26px;margin:0 0 4px;letter-spacing:-.01em;overflow-wrap:anywhere}h2{font-size:15px;margin:0 0 10px}
.lead{color:var(--soft);margin:0 0 18px}
.note{margin:0 0 10px;padding:10px 14px;border-radius:8px;background:var(--note-bg);color:var(--note);overflow-wrap:anywhere}
.note.broken{background:var(--bad-bg);color:var(--bad)}.note.kept{background:none;border:1px solid var(--line);color:var(--good)}
.tiles{display:grid;grid-template-columns:repeat(auto-fit,minmax(118px,1fr));gap:12px;margin:18px 0}
.tile,.card{background:var(--card);border:1px solid var(--line);border-radius:10px}
.tile{padding:12px 14px}.tile b{display:block;font-size:22px;line-height:1.25;font-variant-numeric:tabular-nums}.tile span{color:var(--soft);font-size:13px}
.card{padding:16px 18px;margin-bottom:16px;min-width:0}
.pictures{display:grid;grid-template-columns:repeat(auto-fit,minmax(300px,1fr));gap:12px;margin-bottom:16px}
figure{margin:0;background:var(--card);border:1px solid var(--line);border-radius:10px;overflow:hidden}
figure img{display:block;width:100%;height:auto}figcaption{padding:8px 14px;color:var(--soft);font-size:13px}
.dot{display:inline-block;width:9px;height:9px;border-radius:50%;margin:0 3px 0 8px}
.ramp{display:inline-block;width:90px;height:9px;border-radius:5px;margin:0 6px;background:linear-gradient(90deg,#c8321f,#f7d154,#2f9e62)}
.columns{display:grid;grid-template-columns:repeat(auto-fit,minmax(340px,1fr));gap:0 16px}
svg{display:block;width:100%;height:auto}svg text{fill:var(--soft);font:12px system-ui,sans-serif}
.bar{fill:var(--bar)}.axis{stroke:var(--soft)}.grid{stroke:var(--line)}.ideal{stroke:var(--ideal);stroke-dasharray:4 3;stroke-width:1.5}
.curve{fill:none;stroke:var(--bar);stroke-width:2;stroke-linejoin:round}
.time{display:flex;height:26px;border-radius:6px;overflow:hidden}.time span{min-width:1px}
.legend{display:flex;flex-wrap:wrap;gap:4px 20px;list-style:none;margin:12px 0 0;padding:0}.legend i{display:inline-block;width:10px;height:10px;border-radius:3px;margin-right:7px}
small,.hint{color:var(--soft);font-size:13px}.hint{margin:8px 0 0}
table{width:100%;border-collapse:collapse;font-variant-numeric:tabular-nums}td,th{padding:5px 4px;border-bottom:1px solid var(--line);text-align:left;font-weight:400}td{text-align:right}tr:last-child>*{border-bottom:0}
</style>)";

std::string grouped(std::size_t n) {
  const std::string digits = fmt::format("{}", n);
  std::string result;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) result += ',';
    result += digits[i];
  }
  return result;
}
std::string number(double x) {
  return fmt::format("{:.6g}", x);
}
std::string percent(double x) {
  return fmt::format("{:.2f}\u00a0%", 100 * x);
}
std::string degrees(double x) {
  return fmt::format("{:.2f}°", x);
}

std::string tile(const std::string& value, const char* name) {
  return fmt::format("<div class=\"tile\"><b>{}</b><span>{}</span></div>", value, name);
}

std::string row(const char* name, const std::string& value) {
  return fmt::format("<tr><th>{}</th><td>{}</td></tr>", name, value);
}

std::string card(const char* title, const std::string& body, const char* hint = "") {
  if (body.empty()) return {};
  const std::string below = *hint ? fmt::format("<p class=\"hint\">{}</p>", hint) : "";
  return fmt::format("<section class=\"card\"><h2>{}</h2>{}{}</section>", title, body, below);
}

std::string findings_html(const Report& report) {
  std::string html;
  for (const bool broken : {true, false})
    for (const Finding& finding : report.findings)
      if ((finding.severity == Severity::broken_promise) == broken)
        html += fmt::format("<p class=\"note{}\">{}{}</p>", broken ? " broken" : "",
                            broken ? "<b>A promise could not be kept.</b> " : "", escape_html(finding.sentence));
  const MeshQuality& q = report.quality;
  if (q.closed() && q.two_manifold() && q.oriented() && report.self_intersections == 0 && q.degenerate_faces == 0)
    html += "<p class=\"note kept\">Closed, two-manifold, consistently oriented, without self-intersections.</p>";
  return html;
}

std::string tiles_html(const Report& report) {
  const MeshQuality& q = report.quality;
  double seconds = 0;
  for (const auto& [stage, s] : report.seconds) seconds += s;
  std::string html = tile(grouped(q.vertices), "vertices") + tile(grouped(q.faces), "triangles") +
                     tile(fmt::format("{:.4f}", q.q_avg), "mean quality Q") +
                     tile(fmt::format("{:.3f}", q.q_min), "smallest Q") +
                     tile(degrees(q.theta_avg), "mean smallest angle") + tile(degrees(q.theta_min), "smallest angle") +
                     tile(percent(q.irregular_ratio), "irregular vertices");
  if (report.energy_ratio > 0) html += tile(fmt::format("{:.4f}", report.energy_ratio), "energy ratio (1 = perfect)");
  if (seconds > 0) html += tile(fmt::format("{:.2f}\u00a0s", seconds), "wall time");
  return "<div class=\"tiles\">" + html + "</div>";
}

std::string picture(const Image& image, const char* what, const std::string& caption) {
  return fmt::format(
      "<figure><img alt=\"{}\" width=\"{}\" height=\"{}\" src=\"data:image/png;base64,{}\">"
      "<figcaption>{}</figcaption></figure>",
      what, image.width, image.height, base64(encode_png(image)), caption);
}

/// Draws one mesh several times; its light is computed once.
class Gallery {
 public:
  Gallery(const Mesh& mesh, ExecutionContext& context)
      : mesh_(mesh), context_(context), lit_(light_mesh(mesh, context)) {}

  std::string figure(const RenderOptions& options, const char* caption) const {
    return picture(render_lit(mesh_, lit_, options, context_), "the mesh", caption);
  }

 private:
  const Mesh& mesh_;
  ExecutionContext& context_;
  LitMesh lit_;
};

std::string pictures_html(const Mesh& mesh, ExecutionContext& context) {
  constexpr int width = 680, height = 560;
  const char* marks =
      "valence <i class=\"dot\" style=\"background:#1f6fd6\"></i>5 <i class=\"dot\" style=\"background:#d8352a\"></i>7 "
      "<i class=\"dot\" style=\"background:#8e35c0\"></i>other than 5, 6, 7";
  const Gallery gallery(mesh, context);
  std::string html = gallery.figure({.width = width, .height = height}, marks);
  html += gallery.figure({.width = width, .height = height, .azimuth = 210}, "from the other side");
  html += gallery.figure({.width = width, .height = height, .quality_colours = true},
                         "quality Q 0.5<i class=\"ramp\"></i>1");
  return "<div class=\"pictures\">" + html + "</div>";
}

std::string shell_html(const Mesh& mesh, const Artifacts& kept) {
  if (!kept.shell_cut || kept.shell_cut->voxels.empty()) return {};
  constexpr int width = 680;
  constexpr double window = 48;
  const auto cut = [&](double voxels) { return shell_cut_image(*kept.shell_cut, mesh, width, voxels); };
  return "<div class=\"pictures\">" +
         picture(cut(0), "cut through the shell",
                 "a cut through the shell of voxels, darkest where the surface passes; red: the mesh") +
         picture(cut(window), "cut through the shell, enlarged", fmt::format("{} voxels of it", window)) + "</div>";
}

std::string charts_html(const MeshResult& result) {
  const Report& report = result.report;
  std::string html =
      card("Angles", histogram_svg(histogram_of_angles(result.mesh, 90), "histogram of all angles", "°", 6, 60),
           "All angles of all triangles; 60° is ideal.");
  html +=
      card("Quality Q", histogram_svg(histogram_of_quality(result.mesh, 50), "histogram of triangle quality", "", 5, 1),
           "Q = 6·area / (√3 · half perimeter · longest edge); equilateral triangles have 1.");
  html += card("Energy", energy_svg(report.energies),
               "Energy ratio after every evaluation, all levels in turn; 1 is a perfect hexagonal tiling.");
  return "<div class=\"columns\">" + html + "</div>" + card("Time", time_bar_html(report.seconds));
}

std::string mesh_table(const MeshQuality& q, std::size_t self_intersections) {
  const Vec3 size = q.bounds.empty() ? Vec3{} : q.bounds.size();
  return row("vertices", grouped(q.vertices)) + row("triangles", grouped(q.faces)) +
         row("Euler number", fmt::format("{}", q.euler)) + row("components", grouped(q.components)) +
         row("boundary edges", grouped(q.boundary_edges)) + row("non-manifold edges", grouped(q.non_manifold_edges)) +
         row("non-manifold vertices", grouped(q.non_manifold_vertices)) +
         row("inconsistently oriented edges", grouped(q.inconsistent_edges)) +
         row("degenerate triangles", grouped(q.degenerate_faces)) +
         row("self-intersections (pairs)", grouped(self_intersections)) +
         row("unused vertices", grouped(q.unused_vertices)) + row("area", number(q.area)) +
         row("volume", number(q.volume)) +
         row("bounding box", fmt::format("{} × {} × {}", number(size.x), number(size.y), number(size.z)));
}

std::string quality_table(const MeshQuality& q) {
  return row("Q, smallest", fmt::format("{:.4f}", q.q_min)) + row("Q, mean", fmt::format("{:.4f}", q.q_avg)) +
         row("smallest angle", degrees(q.theta_min)) + row("mean of smallest angles", degrees(q.theta_avg)) +
         row("largest angle", degrees(q.theta_max)) +
         row("triangles with an angle below 30°", percent(q.below_30_ratio)) +
         row("irregular vertices", percent(q.irregular_ratio)) + row("largest valence", grouped(q.max_valence)) +
         row("mean edge length", number(q.edge_length_avg)) +
         row("variation of edge length", percent(q.edge_length_cv));
}

std::string run_table(const Report& r) {
  return row("vertices asked for", grouped(r.seeds_asked)) + row("vertices returned", grouped(r.seeds)) +
         row("samples", grouped(r.samples)) + row("samples per seed α", fmt::format("{:.1f}", r.alpha)) +
         row("grid cells along the longest side", grouped(r.resolution)) + row("grid spacing", number(r.spacing)) +
         row("energy ratio", fmt::format("{:.5f}", r.energy_ratio)) +
         row("energy evaluations", grouped(r.evaluations)) +
         row("seeds inserted for the topology", grouped(r.inserted_seeds)) +
         row("regularization rounds", grouped(r.regularization_rounds)) +
         row("dropped components (dust)", grouped(r.dropped_components)) +
         row("grid points settled by vote", grouped(r.disagreements)) +
         row("peak memory", fmt::format("{:.0f} MB", static_cast<double>(r.peak_memory_bytes) / 1e6));
}

std::string tables_html(const Report& report) {
  const auto table = [](const std::string& rows) { return "<table>" + rows + "</table>"; };
  return "<div class=\"columns\">" + card("Mesh", table(mesh_table(report.quality, report.self_intersections))) +
         card("Triangles", table(quality_table(report.quality))) + card("Run", table(run_table(report))) + "</div>";
}

}  // namespace

std::string report_html(const MeshResult& result, const std::string& title, ExecutionContext& context,
                        const Artifacts& kept) {
  const std::string name = escape_html(title);
  std::string html =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\"><title>";
  html += name + " – evenmesh</title>\n" + style + "</head><body><main>\n";
  html += "<h1>" + name + "</h1><p class=\"lead\">Mesh report by evenmesh</p>\n";
  html += findings_html(result.report) + tiles_html(result.report) + "\n";
  if (!result.mesh.triangles.empty())
    html += pictures_html(result.mesh, context) + "\n" + shell_html(result.mesh, kept) + charts_html(result) + "\n";
  html += tables_html(result.report) + "\n</main></body></html>\n";
  return html;
}

}  // namespace evenmesh
