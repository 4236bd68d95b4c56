#pragma once
/// The statements of an OpenSCAD .csg file as a tree; what they mean is not known here.

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "evenmesh/error.h"
#include "io/source.h"

namespace evenmesh {

/// An argument: undef, true or false, a number, a text, a list.
struct CsgValue {
  enum class Kind { undefined, boolean, number, text, list };
  Kind kind = Kind::undefined;
  double number = 0;  ///< of a boolean: 0 or 1; may be infinite or NaN
  std::string text;
  std::vector<CsgValue> list;
  const char* at = nullptr;  ///< where it begins
};

/// `name(arguments) { children }`
struct CsgNode {
  std::string name;
  std::vector<std::pair<std::string, CsgValue>> arguments;  ///< name "" where none is given
  std::vector<CsgNode> children;
  bool left_out = false;   ///< marked by * or %
  bool only_this = false;  ///< marked by !
  const char* at = nullptr;
};

/// Whether a text begins with a statement of OpenSCAD, behind blanks and comments.
bool begins_like_csg(std::string_view text);

/// Splits a file into its statements.
/// @param depth  of nodes within each other, at most
/// @throws UnusableInput  with line and column: what was expected and what is there
std::vector<CsgNode> parse_csg(const Source& source, std::size_t depth);

/// Throws UnusableInput "name: line L, column C: what".
[[noreturn]] void fail_in_csg(const Source& source, const char* at, std::string_view what);

/// Whether a node is the union of its children: group, union, render, color.
bool is_csg_group(std::string_view name);

/// Throws UnusableInput if a node imports a drawing (DXF, SVG), which is not read.
void refuse_drawing(const Source& source, const CsgNode& node);

/// Throws UnusableInput: a node that is not read.
[[noreturn]] void refuse_csg_node(const Source& source, const CsgNode& node);

/// Runs what may complain without knowing where it is.
template <typename Make>
auto in_csg(const Source& source, const CsgNode& node, const Make& make) {
  try {
    return make();
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    fail_in_csg(source, node.at, node.name + ": " + error.what());
  }
}

/// The argument of that name, or the unnamed one at `position`; nullptr if there is none, or it is undef.
const CsgValue* csg_argument(const CsgNode& node, std::string_view name, std::size_t position);

/// Arguments as what they must be. @throws UnusableInput  they are something else, or not finite
double csg_number(const Source& source, const CsgValue& value);
bool csg_flag(const CsgNode& node, std::string_view name, std::size_t position);
std::vector<double> csg_numbers(const Source& source, const CsgValue& value, std::size_t least, std::size_t most);

}  // namespace evenmesh
