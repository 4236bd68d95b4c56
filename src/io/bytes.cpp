#include "io/bytes.h"

#include <system_error>

#include "evenmesh/error.h"
#include "evenmesh/io.h"

namespace evenmesh {
namespace {

std::string sentence_of(std::error_code error) {
  if (error == std::errc::no_such_file_or_directory) return "no such file; check the name and the folder";
  if (error == std::errc::permission_denied || error == std::errc::operation_not_permitted)
    return "permission denied; it may not be read by you";
  if (error == std::errc::is_a_directory) return "is a directory; name a file in it";
  return "cannot be read (" + error.message() + ")";
}

}  // namespace

std::string name_of_input(const std::filesystem::path& path) {
  return path == "-" ? "standard input" : path.string();
}

FileBytes load_file(const std::filesystem::path& path) {
  if (path.empty()) throw UnusableInput("the name of the file to read is empty; give one, or \"-\" for standard input");
  FileBytes bytes;
  const std::error_code error = path == "-" ? read_standard_input(bytes) : read_to_end(path, bytes);
  if (error) throw UnusableInput(name_of_input(path) + ": " + sentence_of(error));
  return bytes;
}

std::string read_bytes(const std::filesystem::path& path) {
  return std::string(load_file(path).view());
}

}  // namespace evenmesh
