/// Files read and written whole.

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <utility>

#include "core/platform.h"

namespace evenmesh {
namespace {

namespace fs = std::filesystem;

std::error_code last_error() {
  return {errno, std::generic_category()};
}

/// Closes what it opened.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  int fd() const { return fd_; }
  /// Some file systems tell only now that the disk is full.
  std::error_code close() { return ::close(std::exchange(fd_, -1)) == 0 ? std::error_code() : last_error(); }

 private:
  int fd_;
};

/// Sizes of pipes and of files in /proc are not known in advance, and files may grow or shrink.
std::error_code read_all(int fd, FileBytes& bytes) {
  struct stat status {};
  if (::fstat(fd, &status) != 0) return last_error();
  if (S_ISDIR(status.st_mode)) return std::make_error_code(std::errc::is_a_directory);
  const std::size_t expected = S_ISREG(status.st_mode) ? static_cast<std::size_t>(status.st_size) : 0;
  std::size_t capacity = expected + 1;  // one more than expected, so that the end is seen without growing
  bytes = {std::make_unique_for_overwrite<char[]>(capacity), 0};
  while (true) {
    if (bytes.size == capacity) {
      const std::size_t larger = std::max<std::size_t>(2 * capacity, 1 << 16);
      auto data = std::make_unique_for_overwrite<char[]>(larger);
      std::memcpy(data.get(), bytes.data.get(), bytes.size);
      bytes.data = std::move(data);
      capacity = larger;
    }
    const ssize_t got = ::read(fd, bytes.data.get() + bytes.size, capacity - bytes.size);
    if (got == 0) return {};
    if (got > 0) bytes.size += static_cast<std::size_t>(got);
    if (got < 0 && errno != EINTR) return last_error();
  }
}

std::error_code write_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno != EINTR) return last_error();
    if (written > 0) bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return {};
}

/// A name that nobody else uses: of this process, of this call, in the same folder (rename() works only within a disk).
fs::path temporary_name(const fs::path& path) {
  static std::atomic<unsigned> counter{0};
  return path.parent_path() / fmt::format(".evenmesh-{}-{}.tmp", ::getpid(), counter++);
}

/// Removes the temporary file unless it was renamed.
class Temporary {
 public:
  explicit Temporary(fs::path path) : path_(std::move(path)) {}
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  ~Temporary() {
    if (!renamed_) ::unlink(path_.c_str());
  }
  std::error_code rename_to(const fs::path& target) {
    if (::rename(path_.c_str(), target.c_str()) != 0) return last_error();
    renamed_ = true;
    return {};
  }

 private:
  fs::path path_;
  bool renamed_ = false;
};

}  // namespace

std::error_code read_to_end(const fs::path& path, FileBytes& bytes) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  return file.fd() < 0 ? last_error() : read_all(file.fd(), bytes);
}

std::error_code read_standard_input(FileBytes& bytes) {
  return read_all(STDIN_FILENO, bytes);
}

std::error_code write_standard_output(std::string_view bytes) {
  return write_all(STDOUT_FILENO, bytes);
}

std::error_code write_into(const fs::path& path, std::string_view bytes) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (file.fd() < 0) return last_error();
  const std::error_code error = write_all(file.fd(), bytes);
  const std::error_code late = file.close();
  return error ? error : late;
}

std::error_code replace_file(const fs::path& path, std::string_view bytes) {
  struct stat existing {};
  const bool exists = ::stat(path.c_str(), &existing) == 0;
  // The folder's permission is enough for rename(), but a file marked read-only is meant to stay.
  if (exists && ::access(path.c_str(), W_OK) != 0) return last_error();
  fs::path chosen;
  int fd = -1;
  do {
    chosen = temporary_name(path);
    fd = ::open(chosen.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);  // less the umask
  } while (fd < 0 && errno == EEXIST);  // left by a process with the same number that was killed
  if (fd < 0) return last_error();
  Temporary temporary(std::move(chosen));
  Descriptor file(fd);
  std::error_code error = write_all(fd, bytes);
  if (!error && exists && ::fchmod(fd, existing.st_mode & 07777) != 0) error = last_error();
  const std::error_code late = file.close();
  if (!error) error = late;
  return error ? error : temporary.rename_to(path);
}

}  // namespace evenmesh
