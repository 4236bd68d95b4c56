#pragma once
/// The tags of an XML document, one after the other. Enough for 3MF: text between tags, comments, declarations and the
/// prefixes of names are passed over; entities are not expanded (numbers and part names need none).

#include <optional>
#include <string_view>

#include "io/source.h"

namespace evenmesh {

class XmlTags {
 public:
  struct Tag {
    std::string_view name;               ///< without prefix
    std::string_view attributes;         ///< the text behind the name
    bool opens = false, closes = false;  ///< <a> opens, </a> closes, <a/> does both

    /// Calls visit(name, value) for every attribute, names without prefix.
    /// Guarantee: malformed attributes end the visit.
    template <typename Visit>
    void for_each(const Visit& visit) const;
    std::optional<std::string_view> attribute(std::string_view wanted) const;
  };

  /// @param source  name and bytes of the document; must outlive the tags
  explicit XmlTags(const Source& source) : source_(source), rest_(source.bytes) {}

  /// Next tag, nothing at the end. @throws UnusableInput  a tag that does not end, a document type declaration
  std::optional<Tag> next();

 private:
  Tag parse(std::string_view inside) const;

  const Source& source_;
  std::string_view rest_;
};

inline bool is_xml_space(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

template <typename Visit>
void XmlTags::Tag::for_each(const Visit& visit) const {
  const char* p = attributes.data();
  const char* end = p + attributes.size();
  while (true) {
    while (p < end && is_xml_space(*p)) ++p;
    const char* first = p;
    while (p < end && *p != '=' && !is_xml_space(*p)) p = *p == ':' ? first = p + 1 : p + 1;
    const std::string_view key(first, static_cast<std::size_t>(p - first));
    while (p < end && is_xml_space(*p)) ++p;
    if (p == end || *p != '=') return;
    ++p;
    while (p < end && is_xml_space(*p)) ++p;
    if (p == end || (*p != '"' && *p != '\'')) return;
    const char quote = *p++;
    first = p;
    while (p < end && *p != quote) ++p;
    if (p == end) return;
    visit(key, std::string_view(first, static_cast<std::size_t>(p++ - first)));
  }
}

}  // namespace evenmesh
