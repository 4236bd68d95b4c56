#include "output.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "command.h"
#include "evenmesh/names.h"
#include "values.h"

namespace evenmesh::cli {
namespace {

const std::string& known_formats() {
  static const std::string all = joined_names<MeshFormat>();
  return all;
}

}  // namespace

void check_output(const std::string& option, const std::string& path) {
  if (path == "-") return;
  if (path.empty()) throw InvalidInput(fmt::format("{} needs the name of a file", option));
  std::error_code ignored;
  const std::filesystem::path file(path);
  if (std::filesystem::is_directory(file, ignored)) {
    throw InvalidInput(fmt::format("{} {}: this is a folder; name a file in it", option, path));
  }
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  if (!std::filesystem::is_directory(folder, ignored)) {
    throw InvalidInput(fmt::format("{} {}: there is no folder '{}'; create it first", option, path, folder.string()));
  }
  const bool special = std::filesystem::exists(file, ignored) && !std::filesystem::is_regular_file(file, ignored);
  // A regular file appears by renaming, so its folder must be writable; a device is written to itself.
  if (!is_writable(special ? file : folder)) {
    throw InvalidInput(fmt::format("{} {}: '{}' must not be written to; choose another place", option, path,
                                   special ? path : folder.string()));
  }
}

MeshOutput check_mesh_output(const std::string& path, const std::string& format) {
  if (path.empty()) throw InvalidInput("no output; give -o FILE, or -o - for standard output");
  MeshOutput output{.path = path};
  if (!format.empty()) {
    const auto known = format_of_name("mesh." + format);
    if (!known) throw InvalidInput(fmt::format("--format takes one of {}, not '{}'", known_formats(), format));
    output.format = *known;
  } else if (path != "-") {
    const auto known = format_of_name(path);
    const bool special = std::filesystem::exists(path) && !std::filesystem::is_regular_file(path);
    if (!known && !special) {
      throw InvalidInput(
          fmt::format("-o {}: the extension does not say a format; use one of {}, or --format", path, known_formats()));
    }
    output.format = known.value_or(MeshFormat::ply);
  }
  check_output("-o", path);
  return output;
}

void write_output(const MeshOutput& output, const Mesh& mesh) {
  try {
    write_mesh(mesh, output.path, output.format);
  } catch (const UnusableInput& error) {
    throw WriteFailed(error.what());
  }
}

void write_output(const std::string& path, std::string_view bytes) {
  if (path == "-") {
    if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) != bytes.size() || std::fflush(stdout) != 0) {
      throw WriteFailed("standard output cannot be written to");
    }
    return;
  }
  try {
    write_file(path, bytes);
  } catch (const UnusableInput& error) {
    throw WriteFailed(error.what());
  }
}

}  // namespace evenmesh::cli
