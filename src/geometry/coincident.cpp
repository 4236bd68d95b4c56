#include "geometry/coincident.h"

#include <algorithm>
#include <numeric>

#include "geometry/shared_edges.h"
#include "geometry/union_find.h"

namespace evenmesh {
namespace {

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

bool is_turned(const Triangle& t) {
  const auto first = std::min_element(t.begin(), t.end()) - t.begin();
  return t[static_cast<std::size_t>((first + 1) % 3)] > t[static_cast<std::size_t>((first + 2) % 3)];
}

enum class Fate : char { stays, goes, paired };

/// Of every triangle; of those with the same corners at most one stays or is paired.
std::vector<Fate> fates_of(const std::vector<Triangle>& triangles) {
  std::vector<Triangle> key(triangles.size());
  std::transform(triangles.begin(), triangles.end(), key.begin(), sorted);
  std::vector<std::uint32_t> order(triangles.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return key[a] != key[b] ? key[a] < key[b] : a < b; });
  std::vector<Fate> fate(triangles.size(), Fate::stays);
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    std::size_t turned = 0;
    while (end < order.size() && key[order[end]] == key[order[begin]]) turned += is_turned(triangles[order[end++]]);
    const std::size_t copies = end - begin;
    if (copies == 1) continue;
    const bool most = 2 * turned > copies;
    std::size_t chosen = begin;
    while (2 * turned != copies && is_turned(triangles[order[chosen]]) != most) ++chosen;
    for (std::size_t i = begin; i < end; ++i) fate[order[i]] = Fate::goes;
    fate[order[chosen]] = copies % 2 == 1 ? Fate::stays : Fate::paired;
  }
  return fate;
}

/// For every pair, by index: above zero if the surface needs one of it, below if it is a wall.
std::vector<int> votes_of(const std::vector<Triangle>& triangles, const std::vector<Fate>& fate) {
  std::vector<Triangle> left;
  std::vector<std::uint32_t> index;
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    if (fate[t] != Fate::goes) {
      left.push_back(triangles[t]);
      index.push_back(t);
    }
  const std::vector<EdgeUse> uses = edge_uses(left);
  UnionFind patches(left.size());
  std::vector<int> vote(left.size(), 0);
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    std::vector<std::uint32_t> pairs;
    for (const EdgeUse& use : edge)
      if (fate[index[use.triangle]] == Fate::paired) pairs.push_back(use.triangle);
    const std::size_t single = edge.size() - pairs.size();
    if (pairs.size() == 2 && single == 0) patches.unite(pairs[0], pairs[1]);
    if (pairs.size() % 2 == 1) vote[pairs[0]] += single % 2 == 1 ? 1 : -1;
  });
  std::vector<int> sum(left.size(), 0), result(triangles.size(), 0);
  for (std::uint32_t i = 0; i < left.size(); ++i) sum[patches.find(i)] += vote[i];
  for (std::uint32_t i = 0; i < left.size(); ++i) result[index[i]] = sum[patches.find(i)];
  return result;
}

}  // namespace

Coincident take_coincident(std::vector<Triangle>& triangles) {
  Coincident found;
  const std::vector<Fate> fate = fates_of(triangles);
  if (std::all_of(fate.begin(), fate.end(), [](Fate f) { return f == Fate::stays; })) return found;
  const std::vector<int> vote = votes_of(triangles, fate);
  std::size_t kept = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    // Nobody votes where the pairs are closed: a body given twice.
    const bool is_wall = fate[t] == Fate::paired && vote[t] < 0;
    if (is_wall)
      found.walls.push_back(triangles[t]);
    else if (fate[t] != Fate::goes)
      triangles[kept++] = triangles[t];
  }
  found.repeated = triangles.size() - kept - 2 * found.walls.size();
  triangles.resize(kept);
  return found;
}

}  // namespace evenmesh
