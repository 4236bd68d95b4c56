#pragma once
/// Everything once per instruction set that this processor has.

#include <hwy/highway.h>

#include <cstdint>

namespace evenmesh {

/// Calls check(name of the instruction set) while SIMD code runs on that one, for each in turn.
template <typename Check>
void on_every_instruction_set(const Check& check) {
  const auto choose = [](std::int64_t targets) {
    hwy::SetSupportedTargetsForTest(targets);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  };
  for (std::int64_t targets = hwy::SupportedTargets(); targets != 0; targets &= targets - 1) {
    const std::int64_t target = targets & -targets;
    if (target == HWY_EMU128 || target == HWY_SCALAR) continue;
    choose(target);
    check(hwy::TargetName(target));
    choose(0);
  }
}

}  // namespace evenmesh
