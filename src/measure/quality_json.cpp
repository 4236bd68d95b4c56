#include <fmt/format.h>

#include <cmath>

#include "evenmesh/measure.h"

namespace evenmesh {
namespace {

/// Collects `"key": value` pairs; JSON knows no infinity and no NaN.
class JsonObject {
 public:
  void add(const char* key, double value) { put(key, std::isfinite(value) ? fmt::format("{}", value) : "null"); }
  void add(const char* key, std::size_t value) { put(key, fmt::format("{}", value)); }
  void add(const char* key, std::int64_t value) { put(key, fmt::format("{}", value)); }
  void add(const char* key, bool value) { put(key, value ? "true" : "false"); }
  std::string text() const { return "{" + text_ + "\n}"; }

 private:
  void put(const char* key, const std::string& value) {
    text_ += fmt::format("{}\n  \"{}\": {}", text_.empty() ? "" : ",", key, value);
  }
  std::string text_;
};

}  // namespace

std::string quality_json(const MeshQuality& q) {
  JsonObject json;
  json.add("vertices", q.vertices);
  json.add("unused_vertices", q.unused_vertices);
  json.add("faces", q.faces);
  json.add("q_min", q.q_min);
  json.add("q_avg", q.q_avg);
  json.add("theta_min", q.theta_min);
  json.add("theta_avg", q.theta_avg);
  json.add("theta_max", q.theta_max);
  json.add("below_30_ratio", q.below_30_ratio);
  json.add("irregular_ratio", q.irregular_ratio);
  json.add("max_valence", q.max_valence);
  json.add("edge_length_avg", q.edge_length_avg);
  json.add("edge_length_cv", q.edge_length_cv);
  json.add("area", q.area);
  json.add("volume", q.volume);
  json.add("boundary_edges", q.boundary_edges);
  json.add("non_manifold_edges", q.non_manifold_edges);
  json.add("non_manifold_vertices", q.non_manifold_vertices);
  json.add("inconsistent_edges", q.inconsistent_edges);
  json.add("degenerate_faces", q.degenerate_faces);
  json.add("components", q.components);
  json.add("euler", q.euler);
  json.add("closed", q.closed());
  json.add("two_manifold", q.two_manifold());
  json.add("oriented", q.oriented());
  return json.text();
}

}  // namespace evenmesh
