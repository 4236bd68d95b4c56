#include "refine/deviations.h"

#include <algorithm>

#include "core/parallel.h"
#include "geometry/triangle.h"

namespace evenmesh {
namespace {

constexpr double flat_cosine = 0.93;  ///< of triangles' normals with the vertex': edges are off by less than that
constexpr std::size_t grain = 256;    ///< vertices of a task

}  // namespace

Gap GapFinder::largest(std::uint32_t v, std::span<const Vec3> samples) const {
  Gap worst;
  const auto look = [&](const Gap& gap) {
    if (gap.squared_distance > worst.squared_distance) worst = gap;
    return true;
  };
  for (const Vec3& p : samples) look(gap_of_sample(p, v));
  each_of_mesh(v, samples, worst.squared_distance, look);
  return worst;
}

double GapFinder::deviation(std::uint32_t v, std::span<const Vec3> samples, double squared_limit) const {
  if (rings_.triangles(v).empty()) return 0;
  const double least = least_ * rings_.edge_length(v);
  double worst = least * least;
  bool any = false;
  const auto look = [&](const Gap& gap) {
    any |= gap.squared_distance > worst;
    worst = std::max(worst, gap.squared_distance);
    return worst <= squared_limit || !any;
  };
  std::size_t hint = 0;
  for (const Vec3& p : samples)
    if (!is_within(p, v, worst, hint) && !look(gap_of_sample(p, v))) return std::numeric_limits<double>::infinity();
  each_of_mesh(v, samples, worst, look);
  return !any ? 0 : worst <= squared_limit ? worst : std::numeric_limits<double>::infinity();
}

bool GapFinder::all_within(std::uint32_t v, std::span<const Vec3> samples, double squared_limit) const {
  std::size_t hint = 0;
  return std::all_of(samples.begin(), samples.end(),
                     [&](const Vec3& p) { return is_within(p, v, squared_limit, hint); });
}

bool GapFinder::is_bent(std::uint32_t v) const {
  const Vec3 normal = rings_.normal(v);
  for (const std::uint32_t t : rings_.triangles(v))
    if (dot(rings_.normal_of(mesh_.triangles[t]), normal) < flat_cosine) return true;
  return false;
}

template <typename Use>
void GapFinder::each_of_mesh(std::uint32_t v, std::span<const Vec3> samples, const double& squared_least,
                             const Use& use) const {
  if (!projector_ || !is_bent(v)) return;
  const double reach = rings_.edge_length(v);
  const auto look = [&](const Vec3& p) {
    const auto is_near = [&](const Vec3& sample) { return squared_norm(p - sample) <= squared_least; };
    if (std::any_of(samples.begin(), samples.end(), is_near)) return true;
    const Vec3 q = projector_->project(p, reach);
    return use(Gap{p, q, squared_norm(p - q)});
  };
  const auto is_first = [&](std::uint32_t w) { return v <= w || !is_bent(w); };
  const Vec3& at = mesh_.vertices[v];
  if (!look(at)) return;
  for (const std::uint32_t w : rings_.neighbours(v)) {
    if (!look(at + 0.3 * (mesh_.vertices[w] - at))) return;  // in a thin part the middle may be the nearest
    if (is_first(w) && !look(0.5 * (at + mesh_.vertices[w]))) return;
  }
  for (const std::uint32_t t : rings_.triangles(v)) {
    const Triangle& c = mesh_.triangles[t];
    if (std::all_of(c.begin(), c.end(), is_first) &&
        !look((mesh_.vertices[c[0]] + mesh_.vertices[c[1]] + mesh_.vertices[c[2]]) / 3))
      return;
  }
}

Vec3 GapFinder::closest_on(std::uint32_t triangle, const Vec3& p) const {
  const auto [a, b, c] = corners_of(mesh_, triangle);
  return closest_point_on_triangle(p, a, b, c);
}
bool GapFinder::is_within(const Vec3& p, std::uint32_t v, double squared_limit, std::size_t& hint) const {
  const auto around = rings_.triangles(v);
  for (std::size_t i = 0; i < around.size(); ++i, hint = hint + 1 < around.size() ? hint + 1 : 0)
    if (squared_norm(p - closest_on(around[hint], p)) < squared_limit) return true;
  return false;
}
Gap GapFinder::gap_of_sample(const Vec3& p, std::uint32_t v) const {
  Gap gap{{}, p, std::numeric_limits<double>::infinity()};
  for (const std::uint32_t t : rings_.triangles(v)) {
    const Vec3 q = closest_on(t, p);
    if (const double d = squared_norm(p - q); d < gap.squared_distance) gap = {q, p, d};
  }
  return gap;
}

double Deviations::largest() const {
  return squared_.empty() ? 0 : *std::max_element(squared_.begin(), squared_.end());
}

void Deviations::update(const GapFinder& gaps, const CellSamples& cells, const ExecutionContext& context) {
  parallel_for(context, squared_.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (const auto v = static_cast<std::uint32_t>(i); marked_[v]) {
        squared_[v] = gaps.deviation(v, cells.of(v));
        marked_[v] = hopeless_[v] = 0;
      }
  });
}

std::vector<std::uint32_t> Deviations::largest_first(double share) const {
  const double limit = share * share * largest();
  std::vector<std::uint32_t> list;
  for (std::uint32_t v = 0; v < squared_.size(); ++v)
    if (squared_[v] > limit && !hopeless_[v]) list.push_back(v);
  std::sort(list.begin(), list.end(),
            [&](auto a, auto b) { return squared_[a] != squared_[b] ? squared_[a] > squared_[b] : a < b; });
  return list;
}

std::vector<std::uint32_t> Deviations::around_the_largest(std::size_t count, int distance, const VertexRings& rings) {
  std::vector<std::uint32_t> stuck(squared_.size());
  for (std::uint32_t v = 0; v < stuck.size(); ++v) stuck[v] = v;
  const auto end = stuck.begin() + static_cast<std::ptrdiff_t>(std::min(count, stuck.size()));
  std::partial_sort(stuck.begin(), end, stuck.end(),
                    [&](auto a, auto b) { return squared_[a] != squared_[b] ? squared_[a] > squared_[b] : a < b; });
  stuck.erase(end, stuck.end());
  std::vector<char> near(squared_.size(), 0);
  for (const std::uint32_t v : stuck)
    for (const std::uint32_t w : vertices_around(rings, v, distance)) near[w] = 1;
  std::vector<std::uint32_t> list = largest_first(0);
  std::erase_if(list, [&](std::uint32_t v) { return !near[v]; });
  for (const std::uint32_t v : stuck) hopeless_[v] = 0;
  return list;
}

std::vector<std::uint32_t> vertices_around(const VertexRings& rings, std::uint32_t v, int distance) {
  std::vector<std::uint32_t> list{v};
  for (std::size_t begin = 0; distance-- > 0;) {
    const std::size_t end = list.size();
    for (std::size_t i = begin; i < end; ++i)
      for (const std::uint32_t w : rings.neighbours(list[i]))
        if (std::find(list.begin(), list.end(), w) == list.end()) list.push_back(w);
    begin = end;
  }
  return list;
}

}  // namespace evenmesh
