#include "band/sheets.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "grid/brick_union.h"
#include "grid/surface_components.h"

namespace evenmesh {
namespace {

using Index = std::uint32_t;
constexpr Index none = 0xffffffffu;
constexpr double both_sides = 0.02;  ///< share of a part's sites seen from both sides that calls for a cut
constexpr double new_sheet = 0.3;    ///< share of a sheet over uncovered sites; less is the far side of one taken
constexpr std::size_t stride = 7;    ///< every so many sites or samples are asked which sides see them
constexpr double surrounded = 0.98;  ///< share of a rim's neighbours that must be chosen for it to follow

/// A connected set of samples that face the same way, or of those around a rim.
struct Sheet {
  Index id = 0;
  bool rim = false;
  double area = 0, in_front = 0;
  Vec3 middle;        ///< times the area
  double volume = 0;  ///< under it, seen from its own middle
};

/// Numbers the sets 0, 1, … by their roots, in place; returns how many there are.
std::size_t number_sets(std::vector<Index>& roots) {
  Index count = 0;
  for (Index s = 0; s < roots.size(); ++s) roots[s] = roots[s] == s ? count++ : roots[roots[s]];
  return count;
}

class Chooser {
 public:
  Chooser(const BandSurface& surface, const SiteVoxels& sites, double min_area, ExecutionContext& context)
      : surface_(surface),
        samples_(surface.samples),
        sites_(sites),
        min_area_(min_area),
        context_(context),
        bricks_(cube_bricks(samples_, context)),
        covered_(sites.size(), 0) {
    result_.chosen.assign(samples_.size(), 0);
    result_.border.assign(samples_.size(), 0);
    for (const VoxelTile& tile : sites.tiles)
      for_each_voxel(tile, [&](unsigned x, unsigned y, unsigned z) {
        const Voxel c = tile.corner();
        voxel_.push_back({c[0] + std::int32_t(x), c[1] + std::int32_t(y), c[2] + std::int32_t(z)});
      });
  }

  Sheets result() {
    find_parts();
    find_sheets();
    group_members();
    for (const Index sheet : sheets_in_order()) take(sheets_[sheet]);
    drop_scraps();
    close_rims();
    return std::move(result_);
  }

 private:
  bool is_clear(Index s) const { return std::abs(surface_.facing[s]) >= clearly_facing; }
  bool is_rim(Index s) const { return sheets_[sheet_[s]].rim; }

  /// Connected parts, and which of them see sites from both sides.
  void find_parts() {
    part_ = component_roots(samples_, bricks_, context_, [](Index, Index) { return true; });
    const std::size_t parts = number_sets(part_);
    // A sample for each of the sides that see a site; the sign of the site's own normal may mean nothing.
    for (auto& list : seen_) list.assign(sites_.size(), none);
    for (Index s = 0; s < part_.size(); ++s) {
      if (!is_clear(s)) continue;
      const Index site = surface_.site[s];
      if (seen_[0][site] == none)
        seen_[0][site] = s;
      else if (seen_[1][site] == none && opposed(s, seen_[0][site]))
        seen_[1][site] = s;
    }
    std::vector<std::size_t> sites(parts, 0), twice(parts, 0);
    for (std::size_t site = 0; site < sites_.size(); site += stride) {
      const Index s = seen_[0][site];
      if (s == none) continue;
      ++sites[part_[s]];
      twice[part_[s]] += is_seen_across(s, part_);
    }
    needs_cut_.assign(parts, 0);
    for (std::size_t p = 0; p < parts; ++p)
      needs_cut_[p] = static_cast<double>(twice[p]) > both_sides * static_cast<double>(sites[p]);
  }

  /// Whether a condition holds for a site or one beside it: a slanted surface has two layers of sites, and each side
  /// sees its own.
  template <typename Condition>
  bool any_near(const Voxel& v, const Condition& condition) const {
    for (std::int32_t z = -1; z <= 1; ++z)
      for (std::int32_t y = -1; y <= 1; ++y)
        for (std::int32_t x = -1; x <= 1; ++x)
          if (const auto site = sites_.tiles.number({v[0] + x, v[1] + y, v[2] + z}); site && condition(*site))
            return true;
    return false;
  }
  bool opposed(Index s, Index t) const {
    return dot(unpack_normal(samples_.normal[s]), unpack_normal(samples_.normal[t])) < -0.5;
  }
  /// Whether the same set also sees the sample's site from the other side.
  bool is_seen_across(Index s, const std::vector<Index>& set) const {
    return any_near(voxel_[surface_.site[s]], [&](std::uint64_t site) {
      for (const auto& seen : seen_)
        if (const Index t = seen[site]; t != none && set[t] == set[s] && opposed(s, t)) return true;
      return false;
    });
  }

  bool same_sheet(Index a, Index b) const {
    if (!needs_cut_[part_[a]]) return true;
    if (is_clear(a) != is_clear(b)) return false;
    if (!is_clear(a)) return true;
    return dot(unpack_normal(samples_.normal[a]), unpack_normal(samples_.normal[b])) > -0.2;
  }
  void find_sheets() {
    std::size_t count = needs_cut_.size();
    if (std::find(needs_cut_.begin(), needs_cut_.end(), 1) == needs_cut_.end()) {
      sheet_ = part_;
    } else {
      sheet_ = component_roots(samples_, bricks_, context_, [this](Index a, Index b) { return same_sheet(a, b); });
      count = number_sets(sheet_);
    }
    sheets_.resize(count);
    for (Index i = 0; i < count; ++i) sheets_[i].id = i;
    const auto each = [&](const auto& use) {
      for (const SampleBlock& block : samples_.blocks)
        for (Index s = block.begin; s < block.end; ++s)
          use(s, sheets_[sheet_[s]], samples_.block_center(block) + Vec3{samples_.x[s], samples_.y[s], samples_.z[s]},
              double(samples_.area[s]));
    };
    each([&](Index s, Sheet& sheet, const Vec3& p, double area) {
      sheet.rim = needs_cut_[part_[s]] && !is_clear(s);
      sheet.area += area;
      if (surface_.facing[s] > 0) sheet.in_front += area;
      sheet.middle += area * p;
    });
    each([&](Index s, Sheet& sheet, const Vec3& p, double area) {
      sheet.volume += area * dot(p - sheet.middle / sheet.area, unpack_normal(samples_.normal[s]));
    });
  }

  /// The largest first; those in front of the input's triangles, and outsides, count for more.
  std::vector<Index> sheets_in_order() const {
    std::vector<Index> order;
    for (const Sheet& sheet : sheets_)
      if (!sheet.rim && sheet.area > 0) order.push_back(sheet.id);
    const auto weight = [&](Index i) {
      const Sheet& s = sheets_[i];
      return s.area * (s.in_front > 0.5 * s.area ? 1.2 : 1.0) * (s.volume > 0 ? 1.2 : 1.0);
    };
    std::sort(order.begin(), order.end(),
              [&](Index a, Index b) { return weight(a) != weight(b) ? weight(a) > weight(b) : a < b; });
    return order;
  }

  void group_members() {
    first_.assign(sheets_.size() + 1, 0);
    for (const Index sheet : sheet_) ++first_[sheet + 1];
    for (std::size_t i = 0; i < sheets_.size(); ++i) first_[i + 1] += first_[i];
    members_.resize(samples_.size());
    std::vector<Index> next(first_.begin(), first_.end() - 1);
    for (Index s = 0; s < sheet_.size(); ++s) members_[next[sheet_[s]]++] = s;
  }
  std::span<const Index> members(const Sheet& sheet) const {
    return {members_.data() + first_[sheet.id], first_[sheet.id + 1] - first_[sheet.id]};
  }

  /// Takes what lies over sites that are not covered. Of a sheet that sees sites from both sides, like that of a Möbius
  /// strip, one side is taken.
  void take(const Sheet& sheet) {
    const auto list = members(sheet);
    double fresh = 0;
    for (const Index s : list)
      if (!covered_[surface_.site[s]]) fresh += samples_.area[s];
    if (fresh < new_sheet * sheet.area) return;
    if (fresh < min_area_) {
      ++result_.dropped;
      return;
    }
    const bool whole = fresh > 0.97 * sheet.area;
    const bool one_sided = is_one_sided(list);
    ++result_.sheets;
    result_.cut += !whole || one_sided;
    std::vector<Index> taken = one_sided ? one_side_of(list) : std::vector<Index>(list.begin(), list.end());
    if (!whole) std::erase_if(taken, [&](Index s) { return covered_[surface_.site[s]] != 0; });
    for (const Index s : taken) result_.chosen[s] = 1;
    for (const Index s : taken) cover(surface_.site[s]);
  }
  /// The site's neighbours too: those in a second layer, and those in the depth of a crease, are never seen themselves.
  void cover(Index site) {
    if (covered_[site] == 2) return;
    covered_[site] = 2;
    any_near(voxel_[site], [&](std::uint64_t n) {
      if (covered_[n] == 0) covered_[n] = 1;
      return false;
    });
  }
  bool is_one_sided(std::span<const Index> list) const {
    if (!needs_cut_[part_[list.front()]]) return false;
    std::size_t both = 0, tried = 0;
    for (std::size_t i = 0; i < list.size(); i += stride) {
      ++tried;
      both += is_seen_across(list[i], sheet_);
    }
    return both > tried / 10;
  }
  /// Of a one-sided sheet, what lies on one side when that side is carried on from site to site.
  std::vector<Index> one_side_of(std::span<const Index> list) const {
    std::vector<Vec3> up(sites_.size());  // zero: not reached yet
    std::vector<char> in_sheet(sites_.size(), 0);
    for (const Index s : list) in_sheet[surface_.site[s]] = 1;
    std::vector<Index> queue;
    const auto reach = [&](Index site, const Vec3& along) {
      const Vec3 n = unpack_normal(sites_.normal[site]);
      up[site] = dot(n, along) < 0 ? -n : n;
      queue.push_back(site);
    };
    for (const Index first : list) {
      if (up[surface_.site[first]] != Vec3{}) continue;
      reach(surface_.site[first], unpack_normal(samples_.normal[first]));
      for (std::size_t at = queue.size() - 1; at < queue.size(); ++at) {
        const Index site = queue[at];
        any_near(voxel_[site], [&](std::uint64_t n) {
          if (in_sheet[n] && up[n] == Vec3{}) reach(static_cast<Index>(n), up[site]);
          return false;
        });
      }
    }
    std::vector<Index> side;
    for (const Index s : list)
      if (dot(up[surface_.site[s]], unpack_normal(samples_.normal[s])) > 0) side.push_back(s);
    return side;
  }

  /// What is left over between sheets, and smaller than the smallest sheet.
  void drop_scraps() {
    if (result_.cut == 0) return;
    const std::vector<Index> roots = component_roots(samples_, bricks_, context_, [this](Index a, Index b) {
      return result_.chosen[a] && result_.chosen[b] && sheet_[a] == sheet_[b];
    });
    std::vector<float> area(samples_.size(), 0);
    for (std::size_t i = 0; i < roots.size(); ++i)
      if (result_.chosen[i]) area[roots[i]] += samples_.area[i];
    for (std::size_t i = 0; i < roots.size(); ++i) {
      if (!result_.chosen[i] || area[roots[i]] >= min_area_) continue;
      result_.chosen[i] = 0;
      result_.dropped += roots[i] == i;
    }
  }

  /// What looked like a rim, but has chosen samples all around, was a sharp crease. Then the border is marked.
  void close_rims() {
    if (result_.cut == 0 && std::find(needs_cut_.begin(), needs_cut_.end(), 1) == needs_cut_.end()) return;
    std::vector<std::size_t> around(sheets_.size(), 0), chosen(sheets_.size(), 0);
    for_links([&](Index s, Index t) {
      if (is_rim(s) && !is_rim(t)) {
        ++around[sheet_[s]];
        chosen[sheet_[s]] += result_.chosen[t] != 0;
      }
    });
    for (const Sheet& sheet : sheets_)
      if (sheet.rim && around[sheet.id] > 0 &&
          static_cast<double>(chosen[sheet.id]) >= surrounded * static_cast<double>(around[sheet.id]))
        for (const Index s : members(sheet)) result_.chosen[s] = 1;
    for_links([&](Index s, Index t) {
      if (result_.chosen[s] && !result_.chosen[t]) result_.border[s] = 1;
    });
  }
  /// Calls visit(sample, neighbour) for neighbours in parts that are cut, both ways round.
  template <typename Visit>
  void for_links(const Visit& visit) {
    CubeWalker walker(samples_);
    for (const CubeBrick& brick : bricks_) {
      context_.throw_if_cancelled();
      walker.walk(brick, [&](const Index* loop, int n) {
        for (int i = 0; i < n; ++i) {
          const Index s = loop[i], t = loop[i + 1 == n ? 0 : i + 1];
          if (sheet_[s] == sheet_[t] && result_.chosen[s] == result_.chosen[t]) continue;
          visit(s, t);
          visit(t, s);
        }
      });
    }
  }

  const BandSurface& surface_;
  const SampleSet& samples_;
  const SiteVoxels& sites_;
  double min_area_;
  ExecutionContext& context_;
  std::vector<CubeBrick> bricks_;
  std::vector<char> covered_;   ///< by site: 1 beside what is covered, 2 covered itself
  std::vector<Voxel> voxel_;    ///< by site
  std::vector<Index> seen_[2];  ///< by site: samples that see it from opposite sides
  std::vector<Index> part_, sheet_, first_, members_;
  std::vector<char> needs_cut_;  ///< by part
  std::vector<Sheet> sheets_;
  Sheets result_;
};

}  // namespace

Sheets choose_sheets(const BandSurface& surface, const SiteVoxels& sites, double min_area, ExecutionContext& context) {
  return Chooser(surface, sites, min_area, context).result();
}

Sheets outer_sheets(const BandSurface& surface, ExecutionContext& context) {
  const SampleSet& samples = surface.samples;
  const SurfaceComponents parts = surface_components(samples, context);
  const std::vector<double> volume = volumes_within(parts, samples);
  Sheets result;
  result.chosen.resize(samples.size());
  for (Index s = 0; s < samples.size(); ++s) result.chosen[s] = volume[parts.part[s]] > 0;
  result.border.assign(samples.size(), 0);
  result.sheets = static_cast<std::size_t>(std::count_if(volume.begin(), volume.end(), [](double v) { return v > 0; }));
  return result;
}

}  // namespace evenmesh
