// The same bits on every processor: no fused multiply-add, and sums over eight logical lanes. Lane l adds the samples
// l, l + 8, l + 16 …, whether a vector has eight lanes, four, or one.
#include "cvt/cell_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cvt/cell_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace evenmesh {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t max_candidates = 256;
constexpr float far_away = 1e30f;
constexpr std::size_t max_lanes = 8;

using D = hn::CappedTag<float, max_lanes>;
using V = hn::Vec<D>;

struct Nearest2 {
  V first, second;                    // index in the candidate list, as a float
  V distance_first, distance_second;  // |x − s|² − |x|²
};

/// Two smallest of |s|² − 2 x·s over the candidates; strict comparisons keep the first on ties.
HWY_INLINE Nearest2 nearest_two(D d, const BlockView& b, V x, V y, V z) {
  const V far = hn::Set(d, far_away);
  Nearest2 n{hn::Zero(d), hn::Zero(d), far, far};
  for (std::size_t c = 0; c < b.seeds; ++c) {
    const float sx = b.seed_x[c], sy = b.seed_y[c], sz = b.seed_z[c];
    const V g = hn::Sub(hn::Set(d, sx * sx + sy * sy + sz * sz),
                        hn::Add(hn::Add(hn::Mul(x, hn::Set(d, 2 * sx)), hn::Mul(y, hn::Set(d, 2 * sy))),
                                hn::Mul(z, hn::Set(d, 2 * sz))));
    const V index = hn::Set(d, static_cast<float>(c));
    const auto nearer = hn::Lt(g, n.distance_first);
    const auto second = hn::Lt(g, n.distance_second);
    n.second = hn::IfThenElse(nearer, n.first, hn::IfThenElse(second, index, n.second));
    n.distance_second = hn::Min(n.distance_second, hn::Max(g, n.distance_first));
    n.first = hn::IfThenElse(nearer, index, n.first);
    n.distance_first = hn::Min(n.distance_first, g);
  }
  return n;
}

/// Sum of the eight lanes in one fixed order.
HWY_INLINE float sum_lanes(const float* lane) {
  return ((lane[0] + lane[4]) + (lane[2] + lane[6])) + ((lane[1] + lane[5]) + (lane[3] + lane[7]));
}

/// Values i… of an array that ends at `end`; lanes behind the end are zero.
HWY_INLINE V load(D d, const float* from, std::size_t i, std::size_t end) {
  if (end - i >= hn::Lanes(d)) return hn::LoadU(d, from + i);
  HWY_ALIGN float rest[max_lanes] = {};
  for (std::size_t l = 0; l < end - i; ++l) rest[l] = from[i + l];
  return hn::Load(d, rest);
}

/// Values of a small table by lane: one permutation when the table fits a vector.
class Table {
 public:
  Table(D d, const float* values, std::size_t count)
      : values_(values), small_(count <= hn::Lanes(d)), lanes_(hn::LoadU(d, values)) {}
  template <typename Index>
  HWY_INLINE V at(D d, Index index) const {
    return small_ ? hn::TableLookupLanes(lanes_, hn::IndicesFromVec(d, index)) : hn::GatherIndex(d, values_, index);
  }

 private:
  const float* values_;
  bool small_;
  V lanes_;
};

/// Bit c set for every candidate that is the first or second of a lane; all candidates when there are many.
template <typename Index>
HWY_INLINE std::uint32_t present(Index first, Index second) {
  const hn::RebindToUnsigned<D> du;
  const auto one = hn::Set(du, 1u);
  auto bits = hn::Or(hn::Shl(one, hn::BitCast(du, first)), hn::Shl(one, hn::BitCast(du, second)));
  HWY_ALIGN std::uint32_t lane[max_lanes] = {};
  hn::Store(bits, du, lane);
  return (lane[0] | lane[1]) | (lane[2] | lane[3]) | ((lane[4] | lane[5]) | (lane[6] | lane[7]));
}

/// What the samples of one vector give to their first and second seed.
struct Parts {
  V first, second;  // positions in the candidate list
  V mass1, mass2, moment1[3], moment2[3];
};

/// Adds to the sums of candidate c, lane by lane. @param lanes  those of candidate 0, from the vector's first lane on
HWY_INLINE void add_parts(D d, const Parts& parts, std::size_t c, float* lanes) {
  const V index = hn::Set(d, static_cast<float>(c));
  const auto is1 = hn::Eq(parts.first, index), is2 = hn::Eq(parts.second, index);
  float* at = lanes + lane_sums_per_seed * c;
  const auto add = [&](V one, V two, float* sum) {
    hn::StoreU(hn::Add(hn::LoadU(d, sum), hn::Add(hn::IfThenElseZero(is1, one), hn::IfThenElseZero(is2, two))), d, sum);
  };
  add(parts.mass1, parts.mass2, at);
  for (int a = 0; a < 3; ++a) add(parts.moment1[a], parts.moment2[a], at + (a + 1) * max_lanes);
}

double evaluate_block(const BlockView& b, float* lane_sums, const BlockSums& sums) {
  const D d;
  const hn::RebindToSigned<D> di;
  const std::size_t lanes = hn::Lanes(d);
  const bool few = b.seeds <= 32;
  const Table seed[3] = {{d, b.seed_x, b.seeds}, {d, b.seed_y, b.seeds}, {d, b.seed_z, b.seeds}};
  HWY_ALIGN float energy[max_lanes] = {};
  for (std::size_t i = 0; i < lane_sums_per_seed * b.seeds; i += lanes) hn::StoreU(hn::Zero(d), d, lane_sums + i);
  // The two nearest seeds of each sample, and what each of them gets of its footprint. The profile of a footprint
  // across the bisector is 3/(4R)·(1 − t²/R²), the projection of an isotropic density: F and its gradient agree.
  for (std::size_t i = 0; i < b.samples; i += lanes) {
    const V p[3] = {load(d, b.x, i, b.samples), load(d, b.y, i, b.samples), load(d, b.z, i, b.samples)};
    const V w = load(d, b.weight, i, b.samples), area = load(d, b.area, i, b.samples);
    const Nearest2 n = nearest_two(d, b, p[0], p[1], p[2]);
    const auto first = hn::ConvertTo(di, n.first), second = hn::ConvertTo(di, n.second);
    V apart[3], length2 = hn::Set(d, 1e-30f);
    for (int a = 0; a < 3; ++a) {
      apart[a] = hn::Sub(seed[a].at(d, second), seed[a].at(d, first));
      length2 = hn::Add(length2, hn::Mul(apart[a], apart[a]));
    }
    // q = R / |s2 − s1|, u = (distance to the bisector) / R
    const V q = hn::Div(hn::Set(d, b.footprint), hn::Sqrt(hn::Mul(hn::Max(area, hn::Set(d, b.min_area)), length2)));
    const V reach = hn::Mul(length2, q);
    const V u = hn::Min(hn::Div(hn::Mul(hn::Set(d, 0.5f), hn::Sub(n.distance_second, n.distance_first)), reach),
                        hn::Set(d, 1.0f));
    const V u2 = hn::Mul(u, u), rest = hn::Sub(hn::Set(d, 1.0f), u2);
    const V share =
        hn::Mul(hn::Set(d, 0.25f), hn::Add(hn::Sub(hn::Set(d, 2.0f), hn::Mul(hn::Set(d, 3.0f), u)), hn::Mul(u, u2)));
    const V moment =
        hn::Mul(hn::Set(d, 0.1875f), hn::Mul(rest, rest));  // of the part beyond the bisector, in units of R
    const V w2 = hn::Mul(w, share), w1 = hn::Sub(w, w2);
    const V shift = hn::Mul(w, hn::Mul(moment, q));
    const V p2 = hn::Add(hn::Mul(p[0], p[0]), hn::Add(hn::Mul(p[1], p[1]), hn::Mul(p[2], p[2])));
    const V gain = hn::Mul(hn::Add(reach, reach), hn::Sub(moment, hn::Mul(u, share)));
    const std::size_t first_lane = i % max_lanes;
    const V part = hn::Mul(w, hn::Sub(hn::Add(n.distance_first, p2), gain));
    hn::Store(hn::Add(hn::Load(d, energy + first_lane), part), d, energy + first_lane);
    Parts parts{n.first, n.second, w1, w2, {}, {}};
    for (int a = 0; a < 3; ++a) {
      const V move = hn::Mul(shift, apart[a]);
      parts.moment1[a] = hn::Sub(hn::Mul(w1, p[a]), move);
      parts.moment2[a] = hn::Add(hn::Mul(w2, p[a]), move);
    }
    // The few candidates that occur in these lanes; no scattering.
    if (few) {
      for (std::uint32_t bits = present(first, second); bits != 0; bits &= bits - 1)
        add_parts(d, parts, static_cast<std::size_t>(__builtin_ctz(bits)), lane_sums + first_lane);
    } else {
      for (std::size_t c = 0; c < b.seeds; ++c) add_parts(d, parts, c, lane_sums + first_lane);
    }
  }
  for (std::size_t c = 0; c < b.seeds; ++c) {
    const float* at = lane_sums + lane_sums_per_seed * c;
    const float m = sum_lanes(at);
    sums.mass[c] = m;
    sums.mx[c] = sum_lanes(at + max_lanes) - m * b.seed_x[c];
    sums.my[c] = sum_lanes(at + 2 * max_lanes) - m * b.seed_y[c];
    sums.mz[c] = sum_lanes(at + 3 * max_lanes) - m * b.seed_z[c];
  }
  return sum_lanes(energy);
}

/// The nearest few, in order but for ties. Of distances the last bits make room for the index.
/// @param distance2  readable up to a multiple of eight
/// @return  how many
HWY_INLINE std::size_t find_nearest(const float* distance2, std::size_t count, std::size_t* nearest, std::size_t most) {
  const D d;
  const hn::RebindToSigned<D> di;
  constexpr std::int32_t index_bits = max_candidates - 1, none = 0x7fffffff;
  const std::size_t lanes = hn::Lanes(d);
  HWY_ALIGN std::int32_t key[max_candidates];
  for (std::size_t i = 0; i < count; i += lanes) {
    const auto bits = hn::AndNot(hn::Set(di, index_bits), hn::BitCast(di, hn::Load(d, distance2 + i)));
    const auto with_index = hn::Or(bits, hn::Iota(di, static_cast<std::int32_t>(i)));
    hn::Store(count - i < lanes ? hn::IfThenElse(hn::FirstN(di, count - i), with_index, hn::Set(di, none)) : with_index,
              di, key + i);
  }
  std::int32_t last = -1;
  for (std::size_t n = 0; n < most; ++n) {
    auto least = hn::Set(di, none);
    const auto passed = hn::Set(di, last);
    for (std::size_t i = 0; i < count; i += lanes) {
      const auto k = hn::Load(di, key + i);
      least = hn::IfThenElse(hn::Gt(k, passed), hn::Min(least, k), least);
    }
    last = hn::GetLane(hn::MinOfLanes(di, least));
    if (last == none) return n;
    nearest[n] = static_cast<std::size_t>(last & index_bits);
  }
  return most;
}

std::size_t keep_near_seeds(const BlockBox& box, const float* margin, float* x, float* y, float* z, std::uint32_t* seed,
                            std::size_t count) {
  constexpr std::size_t judges = 4;
  if (count <= 2) return count;
  const D d;
  const std::size_t lanes = hn::Lanes(d);
  HWY_ALIGN float distance2[max_candidates], dominated[max_candidates];
  const V cx = hn::Set(d, box.center[0]), cy = hn::Set(d, box.center[1]), cz = hn::Set(d, box.center[2]);
  for (std::size_t i = 0; i < count; i += lanes) {
    const V dx = hn::Sub(hn::LoadU(d, x + i), cx), dy = hn::Sub(hn::LoadU(d, y + i), cy),
            dz = hn::Sub(hn::LoadU(d, z + i), cz);
    hn::Store(hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz)), d, distance2 + i);
    hn::Store(hn::Zero(d), d, dominated + i);
  }
  // The nearest few to the centre judge the others.
  std::size_t judge[judges];
  const std::size_t judge_count = find_nearest(distance2, count, judge, judges);
  // Moves change each distance by up to its margin, so the difference of their squares by the margins' sum times their
  // own.
  const float *half = box.half,
              diameter = 2 * __builtin_sqrtf(half[0] * half[0] + half[1] * half[1] + half[2] * half[2]);
  const V hx = hn::Set(d, 2 * half[0]), hy = hn::Set(d, 2 * half[1]), hz = hn::Set(d, 2 * half[2]);
  for (std::size_t j = 0; j < judge_count; ++j) {
    const std::size_t q = judge[j];
    const V jx = hn::Set(d, x[q]), jy = hn::Set(d, y[q]), jz = hn::Set(d, z[q]), jd = hn::Set(d, distance2[q]);
    const V reach = hn::Add(hn::Sqrt(jd), hn::Set(d, diameter));
    for (std::size_t i = 0; i < count; i += lanes) {
      const V swing = hn::Add(
          hn::Add(hn::Mul(hn::AbsDiff(hn::LoadU(d, x + i), jx), hx), hn::Mul(hn::AbsDiff(hn::LoadU(d, y + i), jy), hy)),
          hn::Mul(hn::AbsDiff(hn::LoadU(d, z + i), jz), hz));
      const V own = hn::Load(d, distance2 + i);
      V slack = hn::Mul(hn::Add(own, jd), hn::Set(d, 1e-5f));
      if (margin != nullptr) {
        const V give = hn::Add(hn::LoadU(d, margin + i), hn::Set(d, margin[q]));
        slack = hn::Add(slack, hn::Mul(give, hn::Add(hn::Sqrt(own), reach)));
      }
      const V farther = hn::Sub(hn::Sub(own, jd), hn::Add(swing, slack));
      const V one = hn::IfThenElseZero(hn::Gt(farther, hn::Zero(d)), hn::Set(d, 1.0f));
      hn::Store(hn::Add(hn::Load(d, dominated + i), one), d, dominated + i);
    }
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count; ++i) {
    x[kept] = x[i];
    y[kept] = y[i];
    z[kept] = z[i];
    seed[kept] = seed[i];
    kept += dominated[i] < 2 ? 1 : 0;
  }
  return kept;
}

SeedsInReach find_seeds_in_reach(const float* center, float radius, const float* x, const float* y, const float* z,
                                 const float* margin, std::size_t count, float* scratch, std::uint32_t* hits) {
  const D d;
  const std::size_t lanes = hn::Lanes(d);
  const V cx = hn::Set(d, center[0]), cy = hn::Set(d, center[1]), cz = hn::Set(d, center[2]),
          far = hn::Set(d, far_away);
  V best = far, second = far;  // smallest distances after the moves, at the worst
  for (std::size_t i = 0; i < count; i += lanes) {
    const V dx = hn::Sub(hn::LoadU(d, x + i), cx), dy = hn::Sub(hn::LoadU(d, y + i), cy),
            dz = hn::Sub(hn::LoadU(d, z + i), cz);
    V distance = hn::Sqrt(hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz)));
    if (count - i < lanes) distance = hn::IfThenElse(hn::FirstN(d, count - i), distance, far);
    const V m = hn::LoadU(d, margin + i), worst = hn::Add(distance, m);
    hn::StoreU(hn::Sub(distance, m), d, scratch + i);
    second = hn::Min(second, hn::Max(best, worst));
    best = hn::Min(best, worst);
  }
  HWY_ALIGN float lane[2 * max_lanes];
  hn::Store(best, d, lane);
  hn::Store(second, d, lane + lanes);
  float least = far_away, next = far_away;
  for (std::size_t l = 0; l < 2 * lanes; ++l) {
    next = lane[l] < least ? least : lane[l] < next ? lane[l] : next;
    least = lane[l] < least ? lane[l] : least;
  }
  SeedsInReach found{0, next < 0.5f * far_away ? next * 1.0001f + 2 * radius : far_away};
  const V limit = hn::Set(d, found.limit);
  for (std::size_t i = 0; i < count; i += lanes) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, hn::Le(hn::LoadU(d, scratch + i), limit), bytes);
    for (unsigned bits = bytes[0]; bits != 0; bits &= bits - 1) {
      const std::size_t at = i + static_cast<std::size_t>(__builtin_ctz(bits));
      if (at < count) hits[found.count++] = static_cast<std::uint32_t>(at);
    }
  }
  return found;
}

void nearest_in_block(const BlockView& b, std::uint32_t* nearest) {
  const D d;
  const std::size_t lanes = hn::Lanes(d);
  const auto to_int = hn::RebindToSigned<D>();
  HWY_ALIGN std::int32_t lane[max_lanes];
  for (std::size_t i = 0; i < b.samples; i += lanes) {
    const V x = load(d, b.x, i, b.samples), y = load(d, b.y, i, b.samples), z = load(d, b.z, i, b.samples);
    V best = hn::Set(d, 1e30f), index = hn::Zero(d);
    for (std::size_t c = 0; c < b.seeds; ++c) {
      const float sx = b.seed_x[c], sy = b.seed_y[c], sz = b.seed_z[c];
      const V g = hn::Sub(hn::Set(d, sx * sx + sy * sy + sz * sz),
                          hn::Add(hn::Add(hn::Mul(x, hn::Set(d, 2 * sx)), hn::Mul(y, hn::Set(d, 2 * sy))),
                                  hn::Mul(z, hn::Set(d, 2 * sz))));
      index = hn::IfThenElse(hn::Lt(g, best), hn::Set(d, static_cast<float>(c)), index);
      best = hn::Min(best, g);
    }
    hn::Store(hn::ConvertTo(to_int, index), to_int, lane);
    for (std::size_t l = 0; l < lanes && i + l < b.samples; ++l) nearest[i + l] = static_cast<std::uint32_t>(lane[l]);
  }
}

void nearest_pair_in_block(const BlockView& b, std::uint32_t* first, std::uint32_t* second, float* distance) {
  const D d;
  const std::size_t lanes = hn::Lanes(d);
  HWY_ALIGN float index1[max_lanes], index2[max_lanes], gap[max_lanes];
  for (std::size_t i = 0; i < b.samples; i += lanes) {
    const Nearest2 n =
        nearest_two(d, b, load(d, b.x, i, b.samples), load(d, b.y, i, b.samples), load(d, b.z, i, b.samples));
    hn::Store(n.first, d, index1);
    hn::Store(n.second, d, index2);
    hn::Store(hn::Sub(n.distance_second, n.distance_first), d, gap);
    for (std::size_t l = 0; l < lanes && i + l < b.samples; ++l) {
      const auto c1 = first[i + l] = static_cast<std::uint32_t>(index1[l]);
      const auto c2 = second[i + l] = static_cast<std::uint32_t>(index2[l]);
      const float dx = b.seed_x[c2] - b.seed_x[c1], dy = b.seed_y[c2] - b.seed_y[c1], dz = b.seed_z[c2] - b.seed_z[c1];
      distance[i + l] = gap[l] / (1e-30f + 2 * __builtin_sqrtf(dx * dx + dy * dy + dz * dz));
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace evenmesh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace evenmesh {

HWY_EXPORT(evaluate_block);
HWY_EXPORT(find_seeds_in_reach);
HWY_EXPORT(keep_near_seeds);
HWY_EXPORT(nearest_in_block);
HWY_EXPORT(nearest_pair_in_block);

double evaluate_block(const BlockView& block, float* lane_sums, const BlockSums& sums) {
  return HWY_DYNAMIC_DISPATCH(evaluate_block)(block, lane_sums, sums);
}
std::size_t keep_near_seeds(const BlockBox& box, const float* margin, float* x, float* y, float* z, std::uint32_t* seed,
                            std::size_t count) {
  if (count > 256) return count;  // a crowd of seeds in one place: all of them are tried
  return HWY_DYNAMIC_DISPATCH(keep_near_seeds)(box, margin, x, y, z, seed, count);
}
SeedsInReach seeds_in_reach(const float center[3], float radius, const float* x, const float* y, const float* z,
                            const float* margin, std::size_t count, float* scratch, std::uint32_t* hits) {
  return HWY_DYNAMIC_DISPATCH(find_seeds_in_reach)(center, radius, x, y, z, margin, count, scratch, hits);
}
void nearest_in_block(const BlockView& block, std::uint32_t* nearest) {
  HWY_DYNAMIC_DISPATCH(nearest_in_block)(block, nearest);
}
void nearest_pair_in_block(const BlockView& block, std::uint32_t* first, std::uint32_t* second, float* distance) {
  HWY_DYNAMIC_DISPATCH(nearest_pair_in_block)(block, first, second, distance);
}

}  // namespace evenmesh
#endif
