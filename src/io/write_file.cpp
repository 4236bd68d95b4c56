/// Files that appear whole or not at all.

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "core/platform.h"
#include "evenmesh/error.h"
#include "evenmesh/io.h"

namespace evenmesh {
namespace {

namespace fs = std::filesystem;

std::string sentence_of(std::error_code error) {
  using std::errc;
  if (error == errc::no_such_file_or_directory || error == errc::not_a_directory)
    return "cannot be written: its folder does not exist; create it first";
  if (error == errc::permission_denied || error == errc::operation_not_permitted)
    return "cannot be written: permission denied; choose another folder";
  if (error == errc::is_a_directory) return "is a directory; name a file in it";
  const std::error_code over_quota(EDQUOT, std::generic_category());  // which std::errc does not name
  if (error == errc::no_space_on_device || error == over_quota) return "cannot be written: the disk is full";
  if (error == errc::read_only_file_system) return "cannot be written: the disk is read-only; choose another folder";
  return "cannot be written (" + error.message() + ")";
}

void require(const std::string& name, std::error_code error) {
  if (error) throw UnusableInput(name + ": " + sentence_of(error));
}

/// Names of open files (/dev/stdout leads to /proc/self/fd/1): what they stand for is written to, not replaced.
bool names_open_file(const fs::path& path) {
  const std::string name = path.string();
  return name.starts_with("/proc/") || name.starts_with("/dev/fd/");
}

/// The name behind symbolic links, so that the file is replaced and the links stay. It need not exist.
fs::path behind_links(fs::path path) {
  constexpr int max_links = 40;  // as many as the kernel follows
  std::error_code error;
  for (int i = 0; i < max_links && !names_open_file(path) && fs::is_symlink(fs::symlink_status(path, error)); ++i) {
    const fs::path target = fs::read_symlink(path, error);
    if (error) break;
    path = target.is_absolute() ? target : path.parent_path() / target;
  }
  return path;
}

}  // namespace

bool is_writable(const fs::path& path) noexcept {
  return may_write(path);
}

void write_file(const fs::path& path, std::string_view bytes) {
  if (path.empty())
    throw InvalidInput("the name of the file to write is empty; give one, or \"-\" for standard output");
  if (path == "-") return require("standard output", write_standard_output(bytes));
  const fs::path target = behind_links(path);
  std::error_code unknown;  // then it is not there, or opening it tells why
  const fs::file_status status = fs::status(target, unknown);
  if (fs::is_directory(status)) require(path.string(), std::make_error_code(std::errc::is_a_directory));
  const bool exists = fs::exists(status);
  const bool special = exists && (!fs::is_regular_file(status) || names_open_file(target));
  require(target.string(), special ? write_into(target, bytes) : replace_file(target, bytes));
}

}  // namespace evenmesh
