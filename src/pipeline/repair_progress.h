#pragma once
/// Whether rounds of repair still help.

#include <algorithm>
#include <cstddef>
#include <limits>

namespace evenmesh {

/// Counts the rounds in which the number of defects did not fall by a fifth.
class RepairProgress {
 public:
  int idle_after(std::size_t defects) {
    idle_ = 10 * defects < 8 * fewest_ ? 0 : idle_ + 1;
    fewest_ = std::min(fewest_, defects);
    return idle_;
  }
  /// As if there had been as many idle rounds.
  void give_up(int rounds) { idle_ = rounds; }

 private:
  std::size_t fewest_ = std::numeric_limits<std::size_t>::max() / 8;
  int idle_ = 0;
};

}  // namespace evenmesh
