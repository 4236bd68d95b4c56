#include "io/source.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <limits>
#include <utility>

#include "core/parallel.h"
#include "evenmesh/error.h"

namespace evenmesh {

void fail(const Source& source, std::string_view what) {
  throw UnusableInput(fmt::format("{}: {}", source.name, what));
}

void fail_at(const Source& source, const char* where, std::string_view what) {
  const auto line = 1 + std::count(source.begin(), std::min(where, source.end()), '\n');
  fail(source, fmt::format("line {}: {}", line, what));
}

std::string quoted(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string shown = "'";
  for (const char c : text.substr(0, longest)) shown += c >= ' ' && c <= '~' ? c : '?';
  return shown + (text.size() > longest ? "…'" : "'");
}

std::string found_at(const Source& source, const char* where) {
  if (where >= source.end()) return "the end of the file";
  if (*where == '\n' || *where == '\r') return "the end of the line";
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
  return quoted({where, static_cast<std::size_t>(std::find_if(where, source.end(), blank) - where)});
}

void remark(const Source& source, Finding finding) {
  if (source.findings) source.findings->push_back(std::move(finding));
}

namespace {

bool all_finite(const Source& source, const std::vector<Vec3>& vertices) {
  std::atomic<bool> finite{true};
  parallel_for(*source.context, vertices.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
    double sum = 0;  // x − x is 0 for finite x and NaN otherwise: one test per piece
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3& v = vertices[i];
      sum += (v.x - v.x) + (v.y - v.y) + (v.z - v.z);
    }
    if (sum != 0) finite = false;
  });
  return finite;
}

}  // namespace

void leave_out_infinite(const Source& source, Mesh& mesh) {
  if (all_finite(source, mesh.vertices)) return;
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> number(mesh.vertices.size(), none);
  std::uint32_t kept = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (!is_finite(mesh.vertices[v])) continue;
    mesh.vertices[kept] = mesh.vertices[v];
    number[v] = kept++;
  }
  const std::size_t vertices = mesh.vertices.size() - kept, triangles = mesh.triangles.size();
  mesh.vertices.resize(kept);
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& v : t) v = number[v];
  std::erase_if(mesh.triangles, [](const Triangle& t) { return std::find(t.begin(), t.end(), none) != t.end(); });
  remark_infinite(source, vertices, "vertex", triangles - mesh.triangles.size());
}

void leave_out_infinite(const Source& source, PointCloud& cloud) {
  if (all_finite(source, cloud.points)) return;
  const std::size_t given = cloud.points.size();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < given; ++i) {
    if (!is_finite(cloud.points[i])) continue;
    cloud.points[kept] = cloud.points[i];
    if (!cloud.normals.empty()) cloud.normals[kept] = cloud.normals[i];
    ++kept;
  }
  cloud.points.resize(kept);
  if (!cloud.normals.empty()) cloud.normals.resize(kept);
  remark_infinite(source, given - kept, "point");
}

void remark_infinite(const Source& source, std::size_t count, std::string_view what, std::size_t triangles) {
  if (count == 0) return;
  std::string words(what);
  if (count > 1) words = what == "vertex" ? "vertices" : words + "s";
  remark(source, make_finding(FindingCode::vertices_not_finite,
                              {{"name", std::string(source.name)},
                               {"count", static_cast<double>(count)},
                               {"what", std::move(words)},
                               {"were", count > 1 ? "were" : "was"},
                               {"triangles", static_cast<double>(triangles)},
                               {"also", triangles == 0   ? ""
                                        : triangles == 1 ? ", with the triangle at it"
                                                         : fmt::format(", with {} triangles", triangles)}}));
}

std::string_view with_unix_lines(std::string_view bytes, std::string& storage) {
  if (bytes.find('\n') != std::string_view::npos || bytes.find('\r') == std::string_view::npos) return bytes;
  storage = bytes;
  std::replace(storage.begin(), storage.end(), '\r', '\n');
  return storage;
}

void InstanceBudget::spend(std::uint64_t count) {
  if (count > left_) {
    fail(source_, "repeats its parts so often that the mesh would be far larger than the file; split the assembly");
  }
  left_ -= count;
}

}  // namespace evenmesh
