#include "features/crowding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace evenmesh {
namespace {

using Index = std::uint32_t;
constexpr Index none = CreaseChain::none;

class Crowding {
 public:
  Crowding(const Creases& creases, double reach) : creases_(creases), reach_(reach) {
    for (Index c = 0; c < creases.chains.size(); ++c)
      for (Index p = 0; p < creases.chains[c].points.size(); ++p) cells_[cell(at({c, p}))].push_back({c, p});
  }

  Creases resolved() const {
    std::vector<char> doomed(creases_.chains.size());
    for (Index c = 0; c < creases_.chains.size(); ++c) doomed[c] = is_crowded(c);
    return without_chains(creases_, doomed);
  }

 private:
  struct Place {
    Index chain, point;
  };
  using Cell = std::array<std::int64_t, 3>;
  const Vec3& at(Place p) const { return creases_.chains[p.chain].points[p.point]; }
  Cell cell(const Vec3& p) const {
    return {std::int64_t(std::floor(p.x / reach_)), std::int64_t(std::floor(p.y / reach_)),
            std::int64_t(std::floor(p.z / reach_))};
  }

  /// Whether a third of the chain's points, not counting those near its ends, have others beside them.
  bool is_crowded(Index c) const {
    const CreaseChain& chain = creases_.chains[c];
    std::size_t asked = 0, crowded = 0;
    for (Index p = 0; p < chain.points.size(); ++p) {
      const bool near_end = chain.from != none && (norm(chain.points[p] - chain.points.front()) < 1.5 * reach_ ||
                                                   norm(chain.points[p] - chain.points.back()) < 1.5 * reach_);
      if (!near_end) ++asked, crowded += has_other_beside({c, p});
    }
    return 3 * crowded > asked;
  }
  bool has_other_beside(Place p) const {
    const CreaseChain& chain = creases_.chains[p.chain];
    const Cell home = cell(at(p));
    for (int d = 0; d < 27; ++d) {
      const auto it = cells_.find({home[0] + d % 3 - 1, home[1] + d / 3 % 3 - 1, home[2] + d / 9 - 1});
      if (it == cells_.end()) continue;
      for (const Place q : it->second) {
        if (squared_norm(at(q) - at(p)) >= reach_ * reach_) continue;
        const double along =
            std::abs(chain.arc[p.point] - chain.arc[std::min<std::size_t>(q.point, chain.arc.size() - 1)]);
        if (q.chain != p.chain || std::min(along, chain.length() - along) > 4 * reach_) return true;
      }
    }
    return false;
  }

  const Creases& creases_;
  double reach_;
  std::map<Cell, std::vector<Place>> cells_;
};

}  // namespace

Creases without_crowded(const Creases& creases, double reach) {
  return Crowding(creases, reach).resolved();
}

Creases without_chains(const Creases& creases, const std::vector<char>& doomed) {
  Creases kept;
  kept.tips = creases.tips;
  std::vector<Index> now(creases.corners.size(), none);
  const auto corner = [&](Index c) {
    if (c == none) return none;
    if (now[c] == none) now[c] = static_cast<Index>(kept.corners.size()), kept.corners.push_back(creases.corners[c]);
    return now[c];
  };
  for (std::size_t i = 0; i < creases.chains.size(); ++i) {
    if (doomed[i]) continue;
    CreaseChain chain = creases.chains[i];
    chain.from = corner(chain.from), chain.to = corner(chain.to);
    kept.chains.push_back(std::move(chain));
  }
  return kept;
}

}  // namespace evenmesh
