#include "topology/closing.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>

#include "grid/morton.h"
#include "grid/solid_editor.h"
#include "topology/ambiguous_faces.h"

namespace evenmesh {
namespace {

constexpr int narrowest = 2, widest = 6;  ///< closing radii, grid spacings
/// Grid spacings that a ball must miss a point by: balls stand on grid points, and would miss some of plain surface.
constexpr double slack = 0.5;
/// Bricks on every side that so many points around one, and the next layer, reach into.
int bricks_within(int margin) {
  return (margin + 8) / 8;
}
constexpr double inside_depth = 1, corner_depth = 0.5;

/// Which grid points are inside, of the bricks around some others: 64 bytes each.
class InsideBits {
 public:
  /// @param reach  bricks on every side
  InsideBits(const SolidEditor& editor, std::span<const std::uint64_t> bricks, int reach, ExecutionContext& context) {
    for (const std::uint64_t key : bricks) {
      const SolidEditor::Brick at = morton_decode(key);
      for (int z = at[2] - reach; z <= at[2] + reach; ++z)
        for (int y = at[1] - reach; y <= at[1] + reach; ++y)
          for (int x = at[0] - reach; x <= at[0] + reach; ++x)
            if (std::min({x, y, z}) >= 0)
              keys_.push_back(morton_code(static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y),
                                          static_cast<std::uint64_t>(z)));
      if (keys_.size() > most_unsorted) tidy();
    }
    tidy();
    bits_.resize(keys_.size());
    parallel_for(context, keys_.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) bits_[b] = bits_of(editor.signs(morton_decode(keys_[b])));
    });
  }

  /// Bit i + 8 j of word k.
  const std::array<std::uint64_t, 8>& of(const SolidEditor::Brick& brick) const {
    const auto it = std::lower_bound(keys_.begin(), keys_.end(), morton_code(brick[0], brick[1], brick[2]));
    return bits_[static_cast<std::size_t>(it - keys_.begin())];
  }

 private:
  static constexpr std::size_t most_unsorted = 1 << 24;
  void tidy() {
    std::sort(keys_.begin(), keys_.end());
    keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
  }
  static std::array<std::uint64_t, 8> bits_of(const BrickSigns& signs) {
    std::array<std::uint64_t, 8> bits{};
    for (int k = 0; k < BrickSigns::points; ++k)
      for (int j = 0; j < BrickSigns::points; ++j)
        for (int i = 0; i < BrickSigns::points; ++i)
          if (signs.inside(i, j, k)) bits[static_cast<std::size_t>(k)] |= std::uint64_t{1} << (8 * j + i);
    return bits;
  }

  std::vector<std::uint64_t> keys_;  ///< ascending
  std::vector<std::array<std::uint64_t, 8>> bits_;
};

/// Squared distances on a cube of grid points around a brick, in grid spacings; no more than `far`.
class Window {
 public:
  /// Distances to the inside points. @param margin  points around the brick's own and the next layer
  Window(const InsideBits& bits, const SolidEditor::Brick& brick, int margin, int radius)
      : margin_(margin),
        side_(BrickSigns::side + 2 * margin),
        far_(static_cast<std::int16_t>((radius + 2) * (radius + 2))),
        value_(static_cast<std::size_t>(side_ * side_ * side_), far_) {
    const int reach = bricks_within(margin);
    for (int z = -reach; z <= reach; ++z)
      for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach; ++x) load(bits, brick, {x, y, z});
    inside_.reserve(value_.size());
    for (const std::int16_t v : value_) inside_.push_back(v == 0);
    if (std::find(value_.begin(), value_.end(), 0) != value_.end()) find_distances(radius + 1);
  }

  /// Distances to the points that are at least `radius` from the inside.
  void turn(int radius) {
    const auto all_far = [&](std::int16_t v) { return v == far_; };
    const bool empty = std::all_of(value_.begin(), value_.end(), all_far);
    for (std::int16_t& v : value_) v = v >= radius * radius ? std::int16_t{0} : far_;
    if (!empty) find_distances(radius + 1);
  }
  int at(int i, int j, int k) const { return value_[place(i, j, k)]; }
  /// Before anything was filled.
  bool inside(int i, int j, int k) const { return inside_[place(i, j, k)] != 0; }

 private:
  std::size_t place(int i, int j, int k) const {
    const int at = ((k + margin_) * side_ + j + margin_) * side_ + i + margin_;
    return static_cast<std::size_t>(at);
  }
  void load(const InsideBits& all, const SolidEditor::Brick& brick, std::array<int, 3> shift) {
    std::array<int, 3> lo{}, hi{};
    SolidEditor::Brick at{};
    for (std::size_t a = 0; a < 3; ++a) {
      const int coordinate = brick[a] + shift[a];
      lo[a] = std::max(-margin_, 8 * shift[a]);
      hi[a] = std::min(BrickSigns::points + margin_, 8 * shift[a] + 7);
      if (coordinate < 0 || lo[a] > hi[a]) return;
      at[a] = static_cast<std::uint16_t>(coordinate);
    }
    const auto& bits = all.of(at);
    for (int k = lo[2]; k <= hi[2]; ++k)
      for (int j = lo[1]; j <= hi[1]; ++j)
        for (int i = lo[0]; i <= hi[0]; ++i)
          if (bits[static_cast<std::size_t>(k - 8 * shift[2])] >> (8 * (j - 8 * shift[1]) + i - 8 * shift[0]) & 1)
            value_[place(i, j, k)] = 0;
  }

  /// From 0 at the points asked for: the least over each axis in turn (Saito and Toriwaki, Pattern Recognition 1994),
  /// row by row, so that the compiler can use vectors.
  void find_distances(int reach) {
    for (const int stride : {1, side_, side_ * side_}) {
      const std::vector<std::int16_t> from = value_;
      for (int d = 1; d <= reach; ++d)
        for (int row = 0; row < side_ * side_; ++row) {
          const int n = stride == 1 ? 0 : stride == side_ ? row % side_ : row / side_;
          const int shift = d * stride, begin = row * side_, ends = stride == 1 ? d : 0;
          if (stride == 1 || n >= d) lower(from, begin + ends, begin + side_, -shift, d);
          if (stride == 1 || n + d < side_) lower(from, begin, begin + side_ - ends, shift, d);
        }
    }
  }
  void lower(const std::vector<std::int16_t>& from, int begin, int end, int shift, int distance) {
    const auto square = static_cast<std::int16_t>(distance * distance);
    const std::int16_t* source = from.data() + shift;
    for (int i = begin; i < end; ++i) {
      const auto sum = static_cast<std::int16_t>(source[i] + square);
      value_[static_cast<std::size_t>(i)] = std::min(value_[static_cast<std::size_t>(i)], sum);
    }
  }

  int margin_, side_;
  std::int16_t far_;
  std::vector<std::int16_t> value_;
  std::vector<char> inside_;
};

/// What distances of both passes look at, and one point more.
int margin_of(int radius) {
  return 2 * radius + 1;
}

/// One brick of a solid whose gaps are filled.
class FilledBrick {
 public:
  FilledBrick(const SolidEditor& editor, const InsideBits& bits, const SolidEditor::Brick& brick,
              std::span<const Ball> places, const std::vector<std::uint32_t>& near)
      : editor_(editor), brick_(brick), before_(editor.signs(brick)) {
    for (const std::uint32_t p : near) {
      places_.push_back(places[p]);
      const int radius = radius_of(places[p]);
      if (windows_.contains(radius)) continue;
      Window& window = windows_.emplace(radius, Window(bits, brick, margin_of(radius), radius)).first->second;
      window.turn(radius);
    }
  }

  NewBlock remake(std::vector<Vec3>& filled) {
    close();
    BrickSigns after = before_;
    for (int k = 0; k < BrickSigns::side; ++k)
      for (int j = 0; j < BrickSigns::side; ++j)
        for (int i = 0; i < BrickSigns::side; ++i) {
          if (before_.inside(i, j, k) || depth(i, j, k) <= 0) continue;
          after.inside(i, j, k) = true;
          if (std::max({i, j, k}) < BrickSigns::points) filled.push_back(editor_.point(brick_, i, j, k));
        }
    const double weight = relative_weight();
    return editor_.remake(brick_, before_, after, [&](const CrossedEdge& edge) -> std::optional<NewCrossing> {
      if (edge.old != BrickSigns::none && before_.inside(edge.at[0], edge.at[1], edge.at[2]) == edge.lower_inside)
        return {};
      return crossing(edge, weight);
    });
  }

 private:
  int radius_of(const Ball& place) const { return closing_radius(place.radius, editor_.samples().grid.spacing); }

  /// The largest place that a point lies in counts: the same one whatever brick asks.
  const Ball* place_at(const Vec3& p) const {
    const Ball* best = nullptr;
    for (const Ball& place : places_)
      if (squared_norm(p - place.center) < place.radius * place.radius && (!best || place.radius > best->radius))
        best = &place;
    return best;
  }
  /// How far beyond the reach of empty balls, grid spacings; −1 or less where nothing is filled.
  double closing_depth(int i, int j, int k) const {
    const Ball* place = place_at(editor_.point(brick_, i, j, k));
    if (place == nullptr || editor_.on_border(brick_, i, j, k)) return -1;
    const int radius = radius_of(*place);
    return std::max(-1.0, std::sqrt(windows_.at(radius).at(i, j, k)) - radius - slack);
  }
  /// Depths for the brick's points and one more on every side; then the corners of cubes with a face whose inside
  /// corners lie diagonally: closing does not help where a wall is one point thick.
  void close() {
    const Window& any = windows_.begin()->second;
    for (int k = -1; k <= BrickSigns::side; ++k)
      for (int j = -1; j <= BrickSigns::side; ++j)
        for (int i = -1; i <= BrickSigns::side; ++i)
          depth_[index(i, j, k)] = any.inside(i, j, k) ? inside_depth : closing_depth(i, j, k);
    std::vector<std::array<int, 3>> ambiguous;
    for (int k = -1; k < BrickSigns::side; ++k)
      for (int j = -1; j < BrickSigns::side; ++j)
        for (int i = -1; i < BrickSigns::side; ++i) {
          unsigned corners = 0;
          for (int c = 0; c < 8; ++c) corners |= depth(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)) > 0 ? 1u << c : 0u;
          if (has_diagonal_face(corners)) ambiguous.push_back({i, j, k});
        }
    for (const auto& [i, j, k] : ambiguous)
      for (int c = 0; c < 8; ++c) {
        const int x = i + (c & 1), y = j + (c >> 1 & 1), z = k + (c >> 2);
        double& depth = depth_[index(x, y, z)];
        if (depth > 0 || editor_.on_border(brick_, x, y, z) || !place_at(editor_.point(brick_, x, y, z))) continue;
        depth = corner_depth;
      }
  }
  static std::size_t index(int i, int j, int k) {
    const int at = ((k + 1) * depths + j + 1) * depths + i + 1;
    return static_cast<std::size_t>(at);
  }
  double depth(int i, int j, int k) const { return depth_[index(i, j, k)]; }

  NewCrossing crossing(const CrossedEdge& edge, double weight) const {
    std::array<int, 3> inner = edge.at, outer = edge.at;
    ++(edge.lower_inside ? outer : inner)[static_cast<std::size_t>(edge.axis)];
    const double in = depth(inner[0], inner[1], inner[2]), out = depth(outer[0], outer[1], outer[2]);
    return {std::clamp(in / std::max(0.1, in - out), 0.02, 0.98), normal(edge, inner), weight};
  }
  /// Towards the empty balls, about the filled point.
  Vec3 normal(const CrossedEdge& edge, const std::array<int, 3>& at) const {
    Vec3 outward;
    outward[edge.axis] = edge.lower_inside ? 1 : -1;
    const Ball* place = place_at(editor_.point(brick_, at[0], at[1], at[2]));
    if (place == nullptr) return outward;
    const Window& w = windows_.at(radius_of(*place));
    const auto distance = [&](int i, int j, int k) { return std::sqrt(static_cast<double>(w.at(i, j, k))); };
    const Vec3 slope{distance(at[0] + 1, at[1], at[2]) - distance(at[0] - 1, at[1], at[2]),
                     distance(at[0], at[1] + 1, at[2]) - distance(at[0], at[1] - 1, at[2]),
                     distance(at[0], at[1], at[2] + 1) - distance(at[0], at[1], at[2] - 1)};
    return norm(slope) > 1e-3 && dot(slope, outward) < 0 ? normalized(-slope) : outward;
  }
  double relative_weight() const {
    const SampleSet& samples = editor_.samples();
    if (samples.even()) return 1;
    const SolidEditor::Sums here = editor_.sums_of(brick_);
    return here.area > 0 ? here.weight / here.area : samples.total_weight / samples.total_area;
  }

  const SolidEditor& editor_;
  SolidEditor::Brick brick_;
  BrickSigns before_;
  std::vector<Ball> places_;
  std::map<int, Window> windows_;  ///< by closing radius
  static constexpr int depths = BrickSigns::side + 2;
  std::array<double, depths * depths * depths> depth_{};
};

}  // namespace

int closing_radius(double radius, double spacing) {
  return std::clamp(static_cast<int>(std::lround(0.5 * radius / spacing)), narrowest, widest);
}

FilledSolid fill_gaps(const SampleSet& samples, std::span<const Ball> places, ExecutionContext& context) {
  const SolidEditor editor(samples);
  std::vector<Vec3> centers;
  std::vector<double> radii;
  for (const Ball& place : places) {
    centers.push_back(place.center);
    radii.push_back(place.radius);
  }
  const auto touched = editor.bricks_near(centers, radii);
  std::vector<std::uint64_t> bricks;
  bricks.reserve(touched.size());
  for (const auto& [key, near] : touched) bricks.push_back(key);
  int widest_here = narrowest;
  for (const double radius : radii) widest_here = std::max(widest_here, closing_radius(radius, samples.grid.spacing));
  const InsideBits bits(editor, bricks, bricks_within(margin_of(widest_here)), context);
  std::vector<NewBlock> made(touched.size());
  std::vector<std::vector<Vec3>> filled(touched.size());
  parallel_for(context, touched.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      made[t] = FilledBrick(editor, bits, morton_decode(touched[t].first), places, touched[t].second).remake(filled[t]);
  });
  FilledSolid result{editor.replace(made, context), {}};
  for (const auto& points : filled) result.points.insert(result.points.end(), points.begin(), points.end());
  return result;
}

}  // namespace evenmesh
