#include "geometry/separate_umbrellas.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "geometry/half_edges.h"

namespace evenmesh {
namespace {

/// Gives every triangle but the first on an edge of three and more, or of two that run the same way, corners of its own
/// there.
bool detach_crowded(Mesh& mesh, std::vector<std::uint32_t>& source) {
  std::vector<std::uint64_t> taken;
  const auto key = [](std::uint32_t a, std::uint32_t b) { return std::uint64_t{a} << 32 | b; };
  for (const Triangle& t : mesh.triangles)
    for (std::size_t c = 0; c < 3; ++c) taken.push_back(key(t[c], t[(c + 1) % 3]));
  std::sort(taken.begin(), taken.end());
  std::vector<std::uint64_t> crowded;  // half-edges of several triangles
  for (std::size_t i = 1; i < taken.size(); ++i)
    if (taken[i] == taken[i - 1]) crowded.push_back(taken[i]);
  if (crowded.empty()) return false;
  crowded.erase(std::unique(crowded.begin(), crowded.end()), crowded.end());
  std::vector<char> met(crowded.size(), 0);
  for (Triangle& t : mesh.triangles)
    for (std::size_t c = 0; c < 3; ++c) {
      const auto at = std::lower_bound(crowded.begin(), crowded.end(), key(t[c], t[(c + 1) % 3]));
      if (at == crowded.end() || *at != key(t[c], t[(c + 1) % 3])) continue;
      if (!std::exchange(met[static_cast<std::size_t>(at - crowded.begin())], 1)) continue;
      for (const std::size_t corner : {c, (c + 1) % 3}) {
        source.push_back(source[t[corner]]);
        mesh.vertices.push_back(mesh.vertices[t[corner]]);
        t[corner] = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
      }
    }
  return true;
}

}  // namespace

std::size_t separate_umbrellas(Mesh& mesh, std::vector<std::uint32_t>& source) {
  const std::size_t given = mesh.vertices.size();
  source.resize(given);
  std::iota(source.begin(), source.end(), 0u);
  for (bool again = true; again; again = detach_crowded(mesh, source)) {
    const std::size_t before = mesh.vertices.size();
    const HalfEdges edges(mesh.triangles, before);
    for (std::uint32_t v = 0; v < before; ++v) {
      std::uint32_t copy = v, last_umbrella = 0;
      edges.visit_umbrellas(v, [&](std::uint32_t h, std::uint32_t umbrella) {
        if (umbrella != last_umbrella) {
          last_umbrella = umbrella, copy = static_cast<std::uint32_t>(mesh.vertices.size());
          mesh.vertices.push_back(mesh.vertices[v]), source.push_back(source[v]);
        }
        mesh.triangles[h / 3][h % 3] = copy;
      });
    }
  }
  return mesh.vertices.size() - given;
}

}  // namespace evenmesh
