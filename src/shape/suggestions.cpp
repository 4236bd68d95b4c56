#include "shape/suggestions.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

namespace evenmesh {
namespace {

constexpr std::size_t longest_name = 64;

/// Number of insertions, deletions, replacements and swaps of neighbours that turn a into b
/// (Damerau, A technique for computer detection and correction of spelling errors, CACM 1964).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), row(b.size() + 1), next(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    next[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      next[j] = std::min({row[j] + 1, next[j - 1] + 1, row[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        next[j] = std::min(next[j], before[j - 2] + 1);
    }
    before.swap(row);
    row.swap(next);
  }
  return row.back();
}

}  // namespace

std::vector<std::string_view> close_names(std::string_view name, const std::vector<std::string_view>& candidates) {
  std::vector<std::pair<std::size_t, std::string_view>> found;
  if (name.empty() || name.size() > longest_name) return {};
  for (const std::string_view candidate : candidates) {
    const std::size_t distance = edit_distance(name, candidate);
    const bool contained = name.size() >= 3 && candidate.find(name) != std::string_view::npos;
    if (contained || distance <= 1 + std::min(name.size(), candidate.size()) / 4)
      found.emplace_back(distance, candidate);
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& p, const auto& q) { return p.first < q.first; });
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < found.size() && i < 5; ++i) names.push_back(found[i].second);
  return names;
}

std::string did_you_mean(std::string_view name, const std::vector<std::string_view>& candidates) {
  const std::vector<std::string_view> names = close_names(name, candidates);
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += i == 0 ? "; did you mean " : i + 1 == names.size() ? " or " : ", ";
    text += names[i];
  }
  return text.empty() ? text : text + "?";
}

}  // namespace evenmesh
