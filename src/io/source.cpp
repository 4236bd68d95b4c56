#include "io/source.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <limits>

#include "core/parallel.h"
#include "evenmesh/error.h"

namespace evenmesh {

void fail(const Source& source, std::string_view what) {
  throw UnusableInput(fmt::format("{}: {}", source.name, what));
}

void fail_at(const Source& source, const char* where, std::string_view what) {
  const auto line = 1 + std::count(source.begin(), std::min(where, source.end()), '\n');
  fail(source, fmt::format("line {}: {}", line, what));
}

std::string quoted(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string shown = "'";
  for (const char c : text.substr(0, longest)) shown += c >= ' ' && c <= '~' ? c : '?';
  return shown + (text.size() > longest ? "…'" : "'");
}

std::string found_at(const Source& source, const char* where) {
  if (where >= source.end()) return "the end of the file";
  if (*where == '\n' || *where == '\r') return "the end of the line";
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
  return quoted({where, static_cast<std::size_t>(std::find_if(where, source.end(), blank) - where)});
}

void require_finite(const Source& source, const std::vector<Vec3>& vertices) {
  constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  std::atomic<std::size_t> first{none};
  parallel_for(*source.context, vertices.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
    double sum = 0;  // x − x is 0 for finite x and NaN otherwise: one test per piece
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3& v = vertices[i];
      sum += (v.x - v.x) + (v.y - v.y) + (v.z - v.z);
    }
    if (sum == 0) return;
    std::size_t i = begin;
    while (is_finite(vertices[i])) ++i;
    std::size_t known = first.load();
    while (i < known && !first.compare_exchange_weak(known, i)) {
    }
  });
  if (first != none) {
    fail(source,
         fmt::format("vertex {} (counted from 0) has a coordinate that is not a finite number; remove it or export "
                     "the file again",
                     first.load()));
  }
}

std::string_view with_unix_lines(std::string_view bytes, std::string& storage) {
  if (bytes.find('\n') != std::string_view::npos || bytes.find('\r') == std::string_view::npos) return bytes;
  storage = bytes;
  std::replace(storage.begin(), storage.end(), '\r', '\n');
  return storage;
}

void InstanceBudget::spend(std::uint64_t count) {
  if (count > left_) {
    fail(source_, "repeats its parts so often that the mesh would be far larger than the file; split the assembly");
  }
  left_ -= count;
}

}  // namespace evenmesh
