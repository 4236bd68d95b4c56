#include "input.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <utility>

#include "evenmesh/io.h"
#include "values.h"

namespace evenmesh::cli {
namespace {

constexpr std::string_view gallery_prefix = "gallery:";

struct PlannedKind {
  std::string_view extension, what;
};
constexpr std::array planned_kinds{
    PlannedKind{".glsl", "reading a distance function in GLSL"},
    PlannedKind{".frag", "reading a distance function in GLSL"},
    PlannedKind{".json", "reading a scene file"},
    PlannedKind{".vdb", "reading an OpenVDB volume"},
    PlannedKind{".nii", "reading a NIfTI volume"},
    PlannedKind{".nii.gz", "reading a NIfTI volume"},
    PlannedKind{".nrrd", "reading an NRRD volume"},
    PlannedKind{".tdx", "reading dexels"},
};

bool ends_with_ignoring_case(std::string_view text, std::string_view ending) {
  return text.size() >= ending.size() && std::equal(ending.rbegin(), ending.rend(), text.rbegin(), [](char a, char b) {
           return a == (b >= 'A' && b <= 'Z' ? b - 'A' + 'a' : b);
         });
}

/// Refuses inputs that are documented but not built yet, unless the file holds a mesh under a misleading name.
void refuse_planned_kinds(const std::string& name) {
  const auto kind = std::find_if(planned_kinds.begin(), planned_kinds.end(),
                                 [&](const PlannedKind& k) { return ends_with_ignoring_case(name, k.extension); });
  if (kind == planned_kinds.end()) return;
  std::ifstream file(name, std::ios::binary);
  if (!file) return;  // whoever reads it says what is wrong with it
  std::string head(4096, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  if (!format_of_content(head)) not_available(fmt::format("{} ({})", kind->what, name));
}

/// Refuses what names no file, or a file that cannot be read yet.
void check_file(const std::string& command, const std::string& name) {
  if (name.starts_with(gallery_prefix)) {
    throw InvalidInput(fmt::format("{} takes a mesh file; make one first: evenmesh mesh {} -o {}.ply", command, name,
                                   name.substr(gallery_prefix.size())));
  }
  refuse_planned_kinds(name);
}

}  // namespace

Mesh read_mesh_file(const std::string& command, const std::string& name, Run& run) {
  check_file(command, name);
  return read_mesh(name, run);
}

std::variant<Mesh, PointCloud> read_file(const std::string& command, const std::string& name, Run& run) {
  check_file(command, name);
  return read_mesh_or_points(name, run);
}

void check_input(const InputArguments& input) {
  const std::size_t count = input.positional.size() + input.expressions.size();
  if (count == 0) {
    throw InvalidInput("no input; name a mesh file, '-' for standard input, gallery:NAME, or an expression after -e");
  }
  if (count > 1) {
    throw InvalidInput(fmt::format("{} inputs where one is taken: '{}' and '{}'{}", count,
                                   input.positional.empty() ? input.expressions[0] : input.positional[0],
                                   input.expressions.empty() ? input.positional[1] : input.expressions.back(),
                                   count > 2 ? ", …" : ""));
  }
  if (input.expressions.empty() && !input.parameters.empty()) {
    throw InvalidInput("-D gives a parameter of an expression; it needs an expression after -e");
  }
}

Shape read_shape(const InputArguments& input, const Box& bounds, Run& run) {
  if (!input.expressions.empty()) return shape_from_expression(input.expressions[0], input.parameters, bounds);
  const std::string& name = input.positional[0];
  if (name.starts_with(gallery_prefix)) return gallery_shape(name.substr(gallery_prefix.size()));
  const std::string title = name == "-" ? "standard input" : name;
  std::variant<Mesh, PointCloud> contents = read_file("mesh", name, run);
  if (auto* points = std::get_if<PointCloud>(&contents)) return shape_from_points(std::move(*points), title);
  return shape_from_mesh(std::get<Mesh>(std::move(contents)), title);
}

}  // namespace evenmesh::cli
