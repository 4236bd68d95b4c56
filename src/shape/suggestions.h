#pragma once
/// Names that were probably meant.

#include <string>
#include <string_view>
#include <vector>

namespace evenmesh {

/// Candidates within a few edits of `name` or that contain it, closest first, at most five.
std::vector<std::string_view> close_names(std::string_view name, const std::vector<std::string_view>& candidates);

/// "; did you mean a, b or c?" or an empty string when nothing is close.
std::string did_you_mean(std::string_view name, const std::vector<std::string_view>& candidates);

}  // namespace evenmesh
