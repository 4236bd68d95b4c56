/// OpenSCAD's .csg: statements `name(arguments);` or `name(arguments) { statements }`, all values written out.

#include "scene/csg_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "evenmesh/error.h"
#include "io/text.h"

namespace evenmesh {
namespace {

bool begins_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '$';
}

class Parser {
 public:
  Parser(const Source& source, std::size_t depth) : source_(source), depth_(depth), p_(source.begin()) {}

  std::vector<CsgNode> read() {
    std::vector<CsgNode> nodes = statements(0);
    if (p_ != source_.end()) fail_in_csg(source_, p_, "'}' closes nothing; remove it");
    return nodes;
  }

 private:
  [[noreturn]] void expected(std::string_view what) const {
    const std::size_t shown = std::min<std::size_t>(1, static_cast<std::size_t>(source_.end() - p_));
    const std::string found = shown == 0         ? "the end of the file"
                              : begins_name(*p_) ? evenmesh::quoted(peek_name())
                                                 : evenmesh::quoted({p_, 1});
    fail_in_csg(source_, p_, fmt::format("expected {}, found {}", what, found));
  }

  std::string_view peek_name() const {
    const char* end = p_;
    while (end != source_.end() && (begins_name(*end) || is_digit(*end))) ++end;
    return {p_, static_cast<std::size_t>(end - p_)};
  }

  std::string_view rest() const { return {p_, static_cast<std::size_t>(source_.end() - p_)}; }

  /// Over blanks and comments.
  void skip() {
    for (;;) {
      while (p_ != source_.end() && (is_blank(*p_) || *p_ == '\n')) ++p_;
      if (rest().starts_with("//")) {
        p_ = next_line(p_, source_.end());
      } else if (rest().starts_with("/*")) {
        const std::size_t end = rest().find("*/", 2);
        if (end == std::string_view::npos) fail_in_csg(source_, p_, "this comment is never closed");
        p_ += end + 2;
      } else {
        return;
      }
    }
  }

  bool take(char c) {
    skip();
    if (p_ == source_.end() || *p_ != c) return false;
    ++p_;
    return true;
  }

  void need(char c, std::string_view what) {
    if (!take(c)) expected(what);
  }

  std::vector<CsgNode> statements(std::size_t depth) {
    std::vector<CsgNode> nodes;
    for (;;) {
      skip();
      if (p_ == source_.end() || *p_ == '}') return nodes;
      if (take(';')) continue;
      if (nodes.size() % 1024 == 0) source_.context->throw_if_cancelled();
      nodes.push_back(statement(depth));
    }
  }

  CsgNode statement(std::size_t depth) {
    if (depth >= depth_) {
      fail_in_csg(source_, p_, fmt::format("is nested too deeply; {} nodes may lie within each other", depth_));
    }
    CsgNode node;
    for (; p_ != source_.end() && std::string_view("*%#!").find(*p_) != std::string_view::npos; ++p_, skip()) {
      node.left_out = node.left_out || *p_ == '*' || *p_ == '%';
      node.only_this = node.only_this || *p_ == '!';
    }
    node.at = p_;
    if (p_ == source_.end() || !begins_name(*p_)) expected("a statement such as cube(size = [1, 1, 1]);");
    node.name = peek_name();
    p_ += node.name.size();
    if (take('='))
      fail_in_csg(source_, node.at, "a .csg file has no variables; make one with openscad -o x.csg x.scad");
    need('(', "'(' behind the name of the statement");
    arguments(node);
    if (take(';')) return node;
    if (p_ != source_.end() && begins_name(*p_)) {
      expected("';' or '{' behind the arguments, as openscad -o x.csg x.scad writes them");
    }
    need('{', "';' or '{' behind the arguments");
    node.children = statements(depth + 1);
    if (!take('}'))
      fail_in_csg(source_, node.at, "the braces of this statement are never closed; the file is truncated");
    return node;
  }

  void arguments(CsgNode& node) {
    if (take(')')) return;
    do {
      skip();
      std::string name;
      const char* start = p_;
      if (p_ != source_.end() && begins_name(*p_)) {
        const std::string_view word = peek_name();
        p_ += word.size();
        if (take('=')) {
          name = word;
        } else {
          p_ = start;
        }
      }
      node.arguments.emplace_back(std::move(name), value(0));
    } while (take(','));
    need(')', "',' or ')' in the arguments");
  }

  CsgValue value(int depth) {
    skip();
    CsgValue made;
    made.at = p_;
    if (p_ == source_.end()) expected("a value");
    if (*p_ == '[') {
      list(made, depth);
    } else if (*p_ == '"') {
      text(made);
    } else if (begins_name(*p_)) {
      word(made);
    } else if (scan_number(p_, source_.end(), made.number)) {
      made.kind = CsgValue::Kind::number;
    } else {
      expected("a value: a number, a text in quotes, a list in brackets, true, false or undef");
    }
    return made;
  }

  void list(CsgValue& made, int depth) {
    constexpr int deepest = 8;  // a matrix has two, paths have two
    if (depth >= deepest) fail_in_csg(source_, p_, "lists are nested too deeply");
    made.kind = CsgValue::Kind::list;
    ++p_;
    if (take(']')) return;
    do {
      made.list.push_back(value(depth + 1));
      if (made.list.size() % 4096 == 0) source_.context->throw_if_cancelled();
    } while (take(','));
    need(']', "',' or ']' in the list");
  }

  void text(CsgValue& made) {
    made.kind = CsgValue::Kind::text;
    for (++p_; p_ != source_.end() && *p_ != '"'; ++p_) {
      if (*p_ == '\\' && p_ + 1 != source_.end()) {
        ++p_;
        made.text += *p_ == 'n' ? '\n' : *p_ == 't' ? '\t' : *p_ == 'r' ? '\r' : *p_;
      } else {
        made.text += *p_;
      }
    }
    if (p_ == source_.end()) fail_in_csg(source_, made.at, "this text is never closed by a quote");
    ++p_;
  }

  void word(CsgValue& made) {
    const std::string_view name = peek_name();
    if (name == "true" || name == "false") {
      made.kind = CsgValue::Kind::boolean;
      made.number = name == "true";
    } else if (name == "inf" || name == "nan") {
      made.kind = CsgValue::Kind::number;
      made.number = name == "inf" ? std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
    } else if (name != "undef") {
      expected("a value; a .csg file has no variables, make one with openscad -o x.csg x.scad");
    }
    p_ += name.size();
  }

  const Source& source_;
  std::size_t depth_;
  const char* p_;
};

}  // namespace

bool begins_like_csg(std::string_view text) {
  constexpr std::array<std::string_view, 25> names{
      "group",   "union",   "render",   "color",      "difference",     "intersection",   "multmatrix",
      "cube",    "sphere",  "cylinder", "polyhedron", "linear_extrude", "rotate_extrude", "square",
      "circle",  "polygon", "import",   "hull",       "minkowski",      "projection",     "text",
      "surface", "offset",  "resize",   "roof"};
  const auto skip = [&](std::string_view blanks) {
    text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  };
  for (skip(" \t\r\n*%!;"); text.starts_with("//") || text.starts_with("/*"); skip(" \t\r\n*%!;")) {
    const std::string_view end = text[1] == '/' ? "\n" : "*/";
    const std::size_t at = text.find(end, 2);
    if (at == std::string_view::npos) return false;
    text.remove_prefix(at + end.size());
  }
  const auto name = std::find_if(names.begin(), names.end(), [&](std::string_view n) {
    return text.starts_with(n) && text.size() > n.size() && !begins_name(text[n.size()]);
  });
  if (name == names.end()) return false;
  text.remove_prefix(name->size());
  skip(" \t\r\n");
  return text.starts_with('(');
}

std::vector<CsgNode> parse_csg(const Source& source, std::size_t depth) {
  return Parser(source, depth).read();
}

void fail_in_csg(const Source& source, const char* at, std::string_view what) {
  const std::string_view before = source.bytes.substr(0, static_cast<std::size_t>(at - source.begin()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t last = before.rfind('\n');
  const std::size_t column = before.size() - (last == std::string_view::npos ? 0 : last + 1) + 1;
  fail(source, fmt::format("line {}, column {}: {}", line, column, what));
}

bool is_csg_group(std::string_view name) {
  return name == "group" || name == "union" || name == "render" || name == "color";
}

void refuse_drawing(const Source& source, const CsgNode& node) {
  const CsgValue* file = csg_argument(node, "file", 0);
  if (file == nullptr || file->kind != CsgValue::Kind::text || file->text.size() < 4) return;
  const std::string_view ending = std::string_view(file->text).substr(file->text.size() - 4);
  for (const auto& [extension, kind] : {std::pair{".dxf", "DXF"}, std::pair{".svg", "SVG"}})
    if (equals_ignoring_case(ending, extension))
      fail_in_csg(
          source, node.at,
          fmt::format("import reads meshes, {} is a drawing ({}); let OpenSCAD extrude it, export that part as a "
                      "mesh and import it",
                      evenmesh::quoted(file->text), kind));
}

void refuse_csg_node(const Source& source, const CsgNode& node) {
  constexpr std::array<std::string_view, 11> known{
      "minkowski",  "projection", "text",       "surface",           "resize", "roof", "fill",
      "import_stl", "import_off", "import_dxf", "dxf_linear_extrude"};
  const bool is_known = std::find(known.begin(), known.end(), node.name) != known.end();
  fail_in_csg(source, node.at,
              fmt::format("{} {} is not supported; export this part as a mesh and import it",
                          is_known ? "the OpenSCAD node" : "the unknown node", evenmesh::quoted(node.name)));
}

const CsgValue* csg_argument(const CsgNode& node, std::string_view name, std::size_t position) {
  std::size_t unnamed = 0;
  for (const auto& [given, value] : node.arguments) {
    if (given == name || (given.empty() && unnamed++ == position)) {
      return value.kind == CsgValue::Kind::undefined ? nullptr : &value;
    }
  }
  return nullptr;
}

double csg_number(const Source& source, const CsgValue& value) {
  if (value.kind != CsgValue::Kind::number || !std::isfinite(value.number)) {
    fail_in_csg(source, value.at, "needs a finite number");
  }
  return value.number;
}

bool csg_flag(const CsgNode& node, std::string_view name, std::size_t position) {
  const CsgValue* value = csg_argument(node, name, position);
  if (value == nullptr) return false;
  switch (value->kind) {
    case CsgValue::Kind::undefined:
      return false;
    case CsgValue::Kind::boolean:
    case CsgValue::Kind::number:
      return value->number != 0;
    case CsgValue::Kind::text:
      return !value->text.empty();
    case CsgValue::Kind::list:
      return !value->list.empty();
  }
  return false;
}

std::vector<double> csg_numbers(const Source& source, const CsgValue& value, std::size_t least, std::size_t most) {
  if (value.kind != CsgValue::Kind::list || value.list.size() < least || value.list.size() > most) {
    fail_in_csg(source, value.at,
                least == most ? fmt::format("needs a list of {} numbers", least)
                              : fmt::format("needs a list of {} to {} numbers", least, most));
  }
  std::vector<double> numbers;
  numbers.reserve(value.list.size());
  for (const CsgValue& item : value.list) numbers.push_back(csg_number(source, item));
  return numbers;
}

}  // namespace evenmesh
