#pragma once
/// Creases that lie too near to each other.

#include "features/feature_curves.h"

namespace evenmesh {

/// Leaves out chains of which a third runs beside other chains, or beside another part of themselves, nearer than
/// `reach` (model units), as around a thin plate; and the corners that are left without a chain.
Creases without_crowded(const Creases& creases, double reach);

/// The creases but for the marked chains, and without corners where none ends any more. @param doomed  by chain
Creases without_chains(const Creases& creases, const std::vector<char>& doomed);

}  // namespace evenmesh
