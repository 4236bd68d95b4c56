#include "io/xml.h"

namespace evenmesh {

std::optional<std::string_view> XmlTags::Tag::attribute(std::string_view wanted) const {
  std::optional<std::string_view> found;
  for_each([&](std::string_view key, std::string_view value) {
    if (key == wanted) found = value;
  });
  return found;
}

XmlTags::Tag XmlTags::parse(std::string_view inside) const {
  Tag tag{{}, {}, true, false};
  if (inside.starts_with('/')) {
    tag.opens = false;
    tag.closes = true;
    inside.remove_prefix(1);
  } else if (inside.ends_with('/')) {
    tag.closes = true;
    inside.remove_suffix(1);
  }
  std::size_t end = 0, first = 0;
  for (; end < inside.size() && !is_xml_space(inside[end]); ++end) {
    if (inside[end] == ':') first = end + 1;
  }
  tag.name = inside.substr(first, end - first);
  tag.attributes = inside.substr(end);
  return tag;
}

std::optional<XmlTags::Tag> XmlTags::next() {
  while (true) {
    const std::size_t open = rest_.find('<');
    if (open == std::string_view::npos) return {};
    rest_.remove_prefix(open + 1);
    const auto skip_behind = [&](std::string_view mark) {
      const std::size_t at = rest_.find(mark);
      if (at == std::string_view::npos) fail_at(source_, rest_.data(), "the XML ends within a tag or comment");
      const std::string_view inside = rest_.substr(0, at);
      rest_.remove_prefix(at + mark.size());
      return inside;
    };
    if (rest_.starts_with("!--")) {
      rest_.remove_prefix(3);
      skip_behind("-->");
    } else if (rest_.starts_with("![CDATA[")) {
      skip_behind("]]>");
    } else if (rest_.starts_with('?')) {
      skip_behind("?>");
    } else if (rest_.starts_with('!')) {
      fail_at(source_, rest_.data(), "the XML has a document type declaration, which 3MF forbids");
    } else {
      // '>' may stand in a quoted value, so quotes are followed.
      char quote = 0;
      for (std::size_t i = 0; i < rest_.size(); ++i) {
        const char c = rest_[i];
        if (quote != 0) {
          if (c == quote) quote = 0;
        } else if (c == '"' || c == '\'') {
          quote = c;
        } else if (c == '>') {
          const std::string_view inside = rest_.substr(0, i);
          rest_.remove_prefix(i + 1);
          return parse(inside);
        }
      }
      fail_at(source_, rest_.data(), "the XML ends within a tag");
    }
  }
}

}  // namespace evenmesh
