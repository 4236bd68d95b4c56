#include "io/bytes.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "evenmesh/error.h"
#include "evenmesh/io.h"

namespace evenmesh {
namespace {

/// Closes what it opened.
class Descriptor {
 public:
  Descriptor(int fd, bool owned) : fd_(fd), owned_(owned) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (owned_ && fd_ >= 0) ::close(fd_);
  }
  int fd() const { return fd_; }

 private:
  int fd_;
  bool owned_;
};

std::string reason(int error) {
  switch (error) {
    case ENOENT:
      return "no such file; check the name and the folder";
    case EACCES:
    case EPERM:
      return "permission denied; it may not be read by you";
    case EISDIR:
      return "is a directory; name a file in it";
    default:
      return "cannot be read (" + std::generic_category().message(error) + ")";
  }
}

/// Reads until the end: sizes of pipes and of files in /proc are not known in advance, and files may grow or shrink.
FileBytes read_to_end(int fd, std::size_t expected, const std::string& name) {
  std::size_t capacity = expected + 1;  // one more than expected, so that the end is seen without growing
  FileBytes bytes{std::make_unique_for_overwrite<char[]>(capacity), 0};
  while (true) {
    if (bytes.size == capacity) {
      const std::size_t larger = std::max<std::size_t>(2 * capacity, 1 << 16);
      auto data = std::make_unique_for_overwrite<char[]>(larger);
      std::memcpy(data.get(), bytes.data.get(), bytes.size);
      bytes.data = std::move(data);
      capacity = larger;
    }
    const ssize_t got = ::read(fd, bytes.data.get() + bytes.size, capacity - bytes.size);
    if (got == 0) return bytes;
    if (got > 0) bytes.size += static_cast<std::size_t>(got);
    if (got < 0 && errno != EINTR) throw UnusableInput(name + ": " + reason(errno));
  }
}

}  // namespace

std::string name_of_input(const std::filesystem::path& path) {
  return path == "-" ? "standard input" : path.string();
}

FileBytes load_file(const std::filesystem::path& path) {
  const bool standard_input = path == "-";
  const std::string name = name_of_input(path);
  if (path.empty()) throw UnusableInput("the name of the file to read is empty; give one, or \"-\" for standard input");
  const Descriptor file(standard_input ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC), !standard_input);
  if (file.fd() < 0) throw UnusableInput(name + ": " + reason(errno));
  struct stat status {};
  if (::fstat(file.fd(), &status) != 0) throw UnusableInput(name + ": " + reason(errno));
  if (S_ISDIR(status.st_mode)) throw UnusableInput(name + ": " + reason(EISDIR));
  return read_to_end(file.fd(), S_ISREG(status.st_mode) ? static_cast<std::size_t>(status.st_size) : 0, name);
}

std::string read_bytes(const std::filesystem::path& path) {
  return std::string(load_file(path).view());
}

}  // namespace evenmesh
