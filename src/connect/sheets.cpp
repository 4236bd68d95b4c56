#include "connect/sheets.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "connect/brick_cubes.h"
#include "connect/union_find.h"

namespace evenmesh {
namespace {

using Index = std::uint32_t;
constexpr Index none = 0xffffffffu;
constexpr double both_sides = 0.02;  ///< share of a part's sites seen from both sides that calls for a cut
constexpr double new_sheet = 0.3;    ///< share of a sheet's area over uncovered sites that makes it worth taking
constexpr double surrounded = 0.98;  ///< share of a rim's neighbours that must be chosen for it to follow

Index side_of(float facing) {
  return facing > 0 ? 0 : 1;
}

/// Calls visit(sample, sample) for neighbours on the surface, every pair at least once.
template <typename Visit>
void for_links(const SampleSet& samples, Run& run, const Visit& visit) {
  CubeWalker walker(samples);
  for (const CubeBrick& brick : cube_bricks(samples, run)) {
    run.throw_if_cancelled();
    walker.walk(brick, [&](const Index* loop, int n) {
      for (int i = 0; i < n; ++i) visit(loop[i], loop[i + 1 == n ? 0 : i + 1]);
    });
  }
}

std::vector<Index> identity(std::size_t count) {
  std::vector<Index> list(count);
  std::iota(list.begin(), list.end(), Index{0});
  return list;
}

/// A connected set of samples that face the same way, or of those around a rim.
struct Sheet {
  Index root = 0;
  double area = 0, in_front = 0;
  double volume = 0;  ///< under it, seen from its own middle
};

class Chooser {
 public:
  Chooser(const ShellSurface& surface, const SiteVoxels& sites, double least_area, Run& run)
      : surface_(surface),
        samples_(surface.samples),
        sites_(sites),
        least_area_(least_area),
        run_(run),
        covered_(sites.size(), 0),
        links_(collect_links()) {
    result_.chosen.assign(samples_.size(), 0);
    for (const VoxelTile& tile : sites.tiles)
      for_each_voxel(tile, [&](unsigned x, unsigned y, unsigned z) {
        const Voxel c = tile.corner();
        voxel_.push_back({c[0] + std::int32_t(x), c[1] + std::int32_t(y), c[2] + std::int32_t(z)});
        group_.push_back(static_cast<Index>(64 * (&tile - &sites.tiles[0]) + 16 * (z / 2) + 4 * (y / 2) + x / 2));
      });
  }

  Sheets result() {
    find_parts();
    find_sheets();
    for (const Sheet& sheet : sheets_in_order()) take(sheet);
    close_rims();
    mark_border();
    return std::move(result_);
  }

 private:
  std::vector<std::pair<Index, Index>> collect_links() const {
    std::vector<std::pair<Index, Index>> links;
    links.reserve(4 * samples_.size());
    for_links(samples_, run_, [&](Index a, Index b) { links.push_back({a, b}); });
    return links;
  }
  bool is_clear(Index s) const { return std::abs(surface_.facing[s]) >= clearly_facing; }

  /// Connected parts, and which of them see sites from both sides.
  void find_parts() {
    part_ = identity(samples_.size());
    for (const auto& [a, b] : links_) unite(part_, a, b);
    for (Index s = 0; s < part_.size(); ++s) part_[s] = find_root(part_, s);
    // By groups of 2³ voxels: a slanted surface has two layers of sites, and each side sees its own.
    std::vector<Index> seen_by[2];
    for (auto& list : seen_by) list.assign(64 * sites_.tiles.size(), none);
    for (Index s = 0; s < part_.size(); ++s)
      if (is_clear(s)) seen_by[side_of(surface_.facing[s])][group_[surface_.site[s]]] = part_[s];
    std::vector<Index> sites(samples_.size(), 0), twice(samples_.size(), 0);
    for (std::size_t g = 0; g < seen_by[0].size(); ++g) {
      const Index front = seen_by[0][g], back = seen_by[1][g];
      if (front != none) ++sites[front];
      if (back != none && back != front) ++sites[back];
      if (front != none && front == back) ++twice[front];
    }
    needs_cut_.assign(samples_.size(), 0);
    for (Index p = 0; p < needs_cut_.size(); ++p) needs_cut_[p] = twice[p] > both_sides * sites[p];
  }

  bool same_sheet(Index a, Index b) const {
    if (!needs_cut_[part_[a]]) return true;
    if (is_clear(a) != is_clear(b)) return false;
    if (!is_clear(a)) return true;
    return dot(unpack_normal(samples_.normal[a]), unpack_normal(samples_.normal[b])) > -0.2;
  }
  void find_sheets() {
    sheet_ = identity(samples_.size());
    for (const auto& [a, b] : links_)
      if (same_sheet(a, b)) unite(sheet_, a, b);
    for (Index s = 0; s < sheet_.size(); ++s) sheet_[s] = find_root(sheet_, s);
  }
  bool is_rim(Index s) const { return needs_cut_[part_[s]] && !is_clear(s); }

  /// The largest first; those in front of the input's triangles, and outsides, count for more.
  std::vector<Sheet> sheets_in_order() const {
    std::vector<Sheet> by_root(samples_.size());
    std::vector<Vec3> middle(samples_.size());
    const auto each = [&](const auto& use) {
      for (const SampleBlock& block : samples_.blocks)
        for (Index s = block.begin; s < block.end; ++s)
          if (!is_rim(s))
            use(s, samples_.block_center(block) + Vec3{samples_.x[s], samples_.y[s], samples_.z[s]},
                double(samples_.area[s]));
    };
    each([&](Index s, const Vec3& p, double area) {
      Sheet& sheet = by_root[sheet_[s]];
      sheet.root = sheet_[s];
      sheet.area += area;
      if (surface_.facing[s] > 0) sheet.in_front += area;
      middle[sheet_[s]] += area * p;
    });
    each([&](Index s, const Vec3& p, double area) {
      Sheet& sheet = by_root[sheet_[s]];
      sheet.volume += area * dot(p - middle[sheet_[s]] / sheet.area, unpack_normal(samples_.normal[s]));
    });
    std::erase_if(by_root, [](const Sheet& s) { return s.area <= 0; });
    const auto weight = [](const Sheet& s) {
      return s.area * (s.in_front > 0.5 * s.area ? 1.2 : 1.0) * (s.volume > 0 ? 1.2 : 1.0);
    };
    std::sort(by_root.begin(), by_root.end(), [&](const Sheet& a, const Sheet& b) {
      return weight(a) != weight(b) ? weight(a) > weight(b) : a.root < b.root;
    });
    return by_root;
  }

  /// Samples of a sheet, by root.
  std::span<const Index> members(Index root) {
    if (members_.empty()) {
      first_.assign(samples_.size() + 1, 0);
      for (const Index r : sheet_) ++first_[r + 1];
      for (std::size_t r = 0; r < samples_.size(); ++r) first_[r + 1] += first_[r];
      members_.resize(samples_.size());
      std::vector<Index> next(first_.begin(), first_.end() - 1);
      for (Index s = 0; s < sheet_.size(); ++s) members_[next[sheet_[s]]++] = s;
    }
    return {members_.data() + first_[root], first_[root + 1] - first_[root]};
  }

  /// Takes what lies over sites that are not covered. A sheet that sees sites from both sides, like that of a Möbius
  /// strip, is taken in front only.
  void take(const Sheet& sheet) {
    const auto list = members(sheet.root);
    double fresh = 0;
    for (const Index s : list)
      if (!covered_[surface_.site[s]]) fresh += samples_.area[s];
    if (fresh < new_sheet * sheet.area) return;
    if (fresh < least_area_) {
      ++result_.dropped;
      return;
    }
    const bool whole = fresh > 0.97 * sheet.area;
    const bool one_sided = is_one_sided(list);
    ++result_.sheets;
    result_.cut += !whole || one_sided;
    std::vector<Index> taken;
    for (const Index s : list) {
      if (!whole && covered_[surface_.site[s]]) continue;
      if (one_sided && surface_.facing[s] < 0) continue;
      result_.chosen[s] = 1, taken.push_back(s);
    }
    for (const Index s : taken) cover(voxel_[surface_.site[s]]);
  }
  /// The site's neighbours too: those in a second layer, and those in the depth of a crease, are never seen themselves.
  void cover(const Voxel& v) {
    for (std::int32_t z = -1; z <= 1; ++z)
      for (std::int32_t y = -1; y <= 1; ++y)
        for (std::int32_t x = -1; x <= 1; ++x)
          if (const auto site = sites_.tiles.number({v[0] + x, v[1] + y, v[2] + z})) covered_[*site] = 1;
  }
  bool is_one_sided(std::span<const Index> list) {
    if (!needs_cut_[part_[list.front()]]) return false;
    // By groups of 2³ voxels, as in find_parts(). Normals of points may point either way: those of the samples count.
    std::size_t both = 0;
    std::vector<std::pair<Index, Index>> in_front;  // group, sample
    for (const Index s : list)
      if (surface_.facing[s] > 0) in_front.push_back({group_[surface_.site[s]], s});
    std::sort(in_front.begin(), in_front.end());
    for (const Index s : list) {
      if (surface_.facing[s] > 0) continue;
      const Index group = group_[surface_.site[s]];
      const auto at = std::lower_bound(in_front.begin(), in_front.end(), std::pair{group, Index{0}});
      both += at != in_front.end() && at->first == group &&
              dot(unpack_normal(samples_.normal[s]), unpack_normal(samples_.normal[at->second])) < -0.5;
    }
    return both > list.size() / 10;
  }

  /// What looked like a rim, but has chosen samples all around, was a sharp crease.
  void close_rims() {
    std::vector<Index> around(samples_.size(), 0), chosen(samples_.size(), 0);
    for (const auto& [a, b] : links_)
      for (const auto& [s, t] : {std::pair{a, b}, std::pair{b, a}})
        if (is_rim(s) && !is_rim(t)) ++around[sheet_[s]], chosen[sheet_[s]] += result_.chosen[t] != 0;
    for (Index s = 0; s < sheet_.size(); ++s)
      if (is_rim(s) && around[sheet_[s]] > 0 && chosen[sheet_[s]] >= surrounded * around[sheet_[s]])
        result_.chosen[s] = 1;
  }

  void mark_border() {
    result_.border.assign(samples_.size(), 0);
    for (const auto& [a, b] : links_)
      if (result_.chosen[a] != result_.chosen[b]) result_.border[result_.chosen[a] ? a : b] = 1;
  }

  const ShellSurface& surface_;
  const SampleSet& samples_;
  const SiteVoxels& sites_;
  double least_area_;
  Run& run_;
  std::vector<char> covered_;  ///< by site
  std::vector<Voxel> voxel_;   ///< by site
  std::vector<Index> group_;   ///< by site: of 2³ voxels
  std::vector<std::pair<Index, Index>> links_;
  std::vector<Index> part_, sheet_, first_, members_;
  std::vector<char> needs_cut_;  ///< by part
  Sheets result_;
};

}  // namespace

Sheets choose_sheets(const ShellSurface& surface, const SiteVoxels& sites, double least_area, Run& run) {
  return Chooser(surface, sites, least_area, run).result();
}

Sheets outer_sheets(const ShellSurface& surface, Run& run) {
  const SampleSet& samples = surface.samples;
  std::vector<Index> part = identity(samples.size());
  for_links(samples, run, [&](Index a, Index b) { unite(part, a, b); });
  // The volume within a part: from its crossings along x. Cavities come out negative.
  std::vector<double> volume(samples.size(), 0);
  for (const SampleBlock& block : samples.blocks)
    for (Index s = block.begin; s < block.end_of_axis(0); ++s) {
      const double x = brick_size * block.brick[0] + samples.edge[s].i() + 0.5;
      volume[find_root(part, s)] += samples.edge[s].lower_end_inside() ? x : -x;
    }
  Sheets result;
  result.chosen.resize(samples.size());
  for (Index s = 0; s < samples.size(); ++s) result.chosen[s] = volume[find_root(part, s)] > 0;
  result.border.assign(samples.size(), 0);
  result.sheets = static_cast<std::size_t>(std::count_if(volume.begin(), volume.end(), [](double v) { return v > 0; }));
  return result;
}

}  // namespace evenmesh
