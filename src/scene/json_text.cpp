#include "scene/json_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "evenmesh/error.h"

namespace evenmesh {
namespace {

using Json = nlohmann::json;

/// Watches what the tree would not show any more: keys given twice, and how deep it goes.
class Watch {
 public:
  Watch(const Source& source, std::size_t depth) : source_(source), depth_(depth) {}

  bool operator()(int, Json::parse_event_t event, Json& parsed) {
    switch (event) {
      case Json::parse_event_t::object_start:
      case Json::parse_event_t::array_start:
        if (open_.size() >= depth_) fail(source_, "is nested too deeply; a scene may have 500 nodes within each other");
        open_.emplace_back();
        break;
      case Json::parse_event_t::object_end:
      case Json::parse_event_t::array_end:
        open_.pop_back();
        break;
      case Json::parse_event_t::key:
        if (!open_.back().insert(parsed.get<std::string>()).second) {
          fail(source_,
               "has the key " + evenmesh::quoted(parsed.get<std::string>()) + " twice in one object; keep one of them");
        }
        break;
      case Json::parse_event_t::value:
        break;
    }
    return true;
  }

 private:
  const Source& source_;
  std::size_t depth_;
  std::vector<std::set<std::string>> open_;  ///< the keys so far of what is open
};

/// "line 3, column 7" of the byte before `behind`.
std::string place_of(std::string_view bytes, std::size_t behind) {
  const std::string_view before = bytes.substr(0, std::min(behind > 0 ? behind - 1 : 0, bytes.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t last = before.rfind('\n');
  return fmt::format("line {}, column {}", line, before.size() - (last == std::string_view::npos ? 0 : last + 1) + 1);
}

}  // namespace

Json parse_json_text(const Source& source, std::size_t depth) {
  Watch watch(source, depth);
  try {
    return Json::parse(
        source.begin(), source.end(),
        [&](int level, Json::parse_event_t event, Json& parsed) { return watch(level, event, parsed); }, true, true);
  } catch (const Json::parse_error& error) {
    const bool end = error.byte > source.bytes.size();
    fail(source, fmt::format("{}: {}", place_of(source.bytes, error.byte),
                             end ? "the JSON text ends too early; the file is truncated"
                                 : "this is no JSON; check the commas, quotes and brackets before it"));
  } catch (const Json::exception&) {
    fail(source, "has a number beyond the range of double");
  }
}

}  // namespace evenmesh
