#include <cmath>
#include <nlohmann/json.hpp>

#include "evenmesh/mesh_shape.h"

namespace evenmesh {
namespace {

nlohmann::ordered_json finding_json(const Finding& finding) {
  nlohmann::ordered_json json;
  json["code"] = finding_name(finding.code);
  json["severity"] = finding.severity == Severity::note      ? "note"
                     : finding.severity == Severity::warning ? "warning"
                                                             : "broken promise";
  if (finding.place) json["place"] = {finding.place->x, finding.place->y, finding.place->z};
  json["values"] = nlohmann::ordered_json::object();
  for (const auto& [name, value] : finding.values)
    std::visit([&, &key = name](const auto& v) { json["values"][key] = v; }, value);
  json["sentence"] = finding.sentence;
  return json;
}

}  // namespace

std::string report_json(const Report& r) {
  // The mesh's figures first, under the same keys as in `info`; the run's after them.
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(quality_json(r.quality));
  json["self_intersections"] = r.self_intersections;
  json["seeds"] = r.seeds;
  json["seeds_asked"] = r.seeds_asked;
  json["samples"] = r.samples;
  json["alpha"] = r.alpha;
  json["resolution"] = r.resolution;
  json["spacing"] = r.spacing;
  json["energy_ratio"] = r.energy_ratio;
  json["energies"] = r.energies;
  json["evaluations"] = r.evaluations;
  json["disagreements"] = r.disagreements;
  json["unresolved"] = r.unresolved;
  json["filled_cavities"] = r.filled_cavities;
  json["dropped_components"] = r.dropped_components;
  json["sites"] = r.sites;
  json["shell_voxels"] = r.shell_voxels;
  json["thickness"] = r.thickness;
  json["merges"] = r.merges;
  json["thickness_apart"] = r.thickness_apart;
  json["sheets"] = r.sheets;
  json["cuts"] = r.cuts;
  json["crease_vertices"] = r.crease_vertices;
  json["crease_length"] = r.crease_length;
  json["inserted_seeds"] = r.inserted_seeds;
  json["regularization_rounds"] = r.regularization_rounds;
  json["cycle_shares"] = r.cycle_shares;
  json["seconds"] = nlohmann::ordered_json::object();
  for (const auto& [stage, seconds] : r.seconds) json["seconds"][stage] = seconds;
  json["peak_memory_bytes"] = r.peak_memory_bytes;
  json["findings"] = nlohmann::ordered_json::array();
  for (const Finding& finding : r.findings) json["findings"].push_back(finding_json(finding));
  return json.dump(2);
}

}  // namespace evenmesh
