#include "summary.h"

#include <fmt/format.h>

namespace evenmesh::cli {
namespace {

std::string row(const char* name, const std::string& value) {
  return fmt::format("  {:<22} {}\n", name, value);
}

std::string counted(std::size_t number, const char* one, const char* many) {
  return fmt::format("{} {}", grouped(number), number == 1 ? one : many);
}

std::string quality_line(const MeshQuality& q) {
  return fmt::format("least {:.3f}, mean {:.4f}  (1 = equilateral)", q.q_min, q.q_avg);
}

std::string size_line(const Box& box) {
  const Vec3 size = box.empty() ? Vec3{} : box.size();
  return fmt::format("{:.6g} x {:.6g} x {:.6g}, diagonal {:.6g}", size.x, size.y, size.z, box.diagonal());
}

std::string angle_line(const MeshQuality& q) {
  return fmt::format("smallest {:.1f}°, mean smallest {:.2f}°, largest {:.1f}°; {:.3f} % of triangles below 30°",
                     q.theta_min, q.theta_avg, q.theta_max, 100 * q.below_30_ratio);
}

}  // namespace

std::string grouped(std::size_t number) {
  if (number < 1000) return fmt::format("{}", number);
  return fmt::format("{},{:03}", grouped(number / 1000), number % 1000);
}

std::string topology(const MeshQuality& q) {
  std::string text =
      q.closed() ? "closed" : fmt::format("open ({})", counted(q.boundary_edges, "boundary edge", "boundary edges"));
  text += q.two_manifold() ? ", two-manifold"
                           : fmt::format(", not two-manifold ({} edges, {} vertices)", grouped(q.non_manifold_edges),
                                         grouped(q.non_manifold_vertices));
  text += q.oriented() ? ", oriented" : fmt::format(", not oriented ({} edges)", grouped(q.inconsistent_edges));
  text += fmt::format(", {}, Euler number {}", counted(q.components, "component", "components"), q.euler);
  if (q.closed() && q.two_manifold() && q.components == 1) text += fmt::format(" (genus {})", (2 - q.euler) / 2);
  return text;
}

std::string summary(const Report& report, const std::string& output, double seconds) {
  const MeshQuality& q = report.quality;
  std::string text = fmt::format("{}: {} vertices, {} faces", output == "-" ? "standard output" : output,
                                 grouped(q.vertices), grouped(q.faces));
  if (report.inserted_seeds > 0) text += fmt::format(" ({} added for the topology)", grouped(report.inserted_seeds));
  text += "\n";
  text += row("quality Q", quality_line(q));
  text += row("angles", angle_line(q));
  text += row("irregular vertices", fmt::format("{:.1f} %", 100 * q.irregular_ratio));
  text += row("topology", topology(q));
  text += row("self-intersections", report.self_intersections == 0 ? "none" : grouped(report.self_intersections));
  text += row("edge length", fmt::format("{:.6g}, varies by {:.1f} %", q.edge_length_avg, 100 * q.edge_length_cv));
  text += row("energy", fmt::format("{:.4f} of a perfect hexagonal tiling; {} samples, {:.0f} per vertex",
                                    report.energy_ratio, grouped(report.samples), report.alpha));
  text += row("time", fmt::format("{:.2f} s, {:.0f} MB", seconds, static_cast<double>(report.peak_memory_bytes) / 1e6));
  return text;
}

std::string table(const MeshQuality& q, std::size_t self_intersections, std::optional<LengthUnit> unit) {
  std::string text;
  text += row("vertices", grouped(q.vertices) +
                              (q.unused_vertices ? fmt::format(" (and {} unused)", grouped(q.unused_vertices)) : ""));
  text += row("faces", grouped(q.faces));
  text += row("quality Q", quality_line(q));
  text += row("angles", angle_line(q));
  text +=
      row("irregular vertices", fmt::format("{:.2f} % (largest valence {})", 100 * q.irregular_ratio, q.max_valence));
  text += row("topology", topology(q));
  text +=
      row("self-intersections",
          self_intersections == 0 ? "none" : counted(self_intersections, "pair of triangles", "pairs of triangles"));
  text += row("degenerate triangles", q.degenerate_faces == 0 ? "none" : grouped(q.degenerate_faces));
  text += row("edge length", fmt::format("{:.6g}, varies by {:.1f} %", q.edge_length_avg, 100 * q.edge_length_cv));
  text += row("area", fmt::format("{:.8g}", q.area));
  text += row("volume", fmt::format("{:.8g}", q.volume));
  text += row("size", size_line(q.bounds));
  if (unit) text += row("unit", std::string(word_of(*unit)));
  return text;
}

std::string table(const PointCloud& cloud, double spacing) {
  const Box box = cloud.bounds();
  std::string text;
  text += row("points", grouped(cloud.points.size()));
  text += row("normals", cloud.normals.empty() ? "no" : "yes");
  text += row("spacing", fmt::format("{:.6g} (median distance to the sixth nearest point)", spacing));
  text += row("size", size_line(box));
  text += row("from", fmt::format("{:.9g}, {:.9g}, {:.9g}", box.lo.x, box.lo.y, box.lo.z));
  text += row("to", fmt::format("{:.9g}, {:.9g}, {:.9g}", box.hi.x, box.hi.y, box.hi.z));
  return text;
}

}  // namespace evenmesh::cli
