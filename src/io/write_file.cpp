/// Files that appear whole or not at all.

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <system_error>

#include "evenmesh/error.h"
#include "evenmesh/io.h"

namespace evenmesh {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_to_write(const std::string& name, int error) {
  const auto sentence = [&]() -> std::string {
    switch (error) {
      case ENOENT:
      case ENOTDIR:
        return "cannot be written: its folder does not exist; create it first";
      case EACCES:
      case EPERM:
        return "cannot be written: permission denied; choose another folder";
      case EISDIR:
        return "is a directory; name a file in it";
      case ENOSPC:
      case EDQUOT:
        return "cannot be written: the disk is full";
      case EROFS:
        return "cannot be written: the disk is read-only; choose another folder";
      default:
        return "cannot be written (" + std::generic_category().message(error) + ")";
    }
  };
  throw UnusableInput(name + ": " + sentence());
}

/// 0, or the number of the error.
int write_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno != EINTR) return errno;
    if (written > 0) bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

/// Writes into what is there: a device or a pipe, which must not be replaced by a file.
void write_directly(const fs::path& path, std::string_view bytes) {
  const int fd = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (fd < 0) fail_to_write(path.string(), errno);
  int error = write_all(fd, bytes);
  if (::close(fd) != 0 && error == 0) error = errno;
  if (error != 0) fail_to_write(path.string(), error);
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
  const fs::path& path() const { return path_; }
  int rename_to(const fs::path& target) {
    if (::rename(path_.c_str(), target.c_str()) != 0) return errno;
    renamed_ = true;
    return 0;
  }

 private:
  fs::path path_;
  bool renamed_ = false;
};

void replace_file(const fs::path& path, std::string_view bytes, const struct stat* existing) {
  const std::string name = path.string();
  // The folder's permission is enough for rename(), but a file marked read-only is meant to stay.
  if (existing && ::access(path.c_str(), W_OK) != 0) fail_to_write(name, errno);
  fs::path chosen;
  int fd = -1;
  do {
    chosen = temporary_name(path);
    fd = ::open(chosen.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);  // less the umask
  } while (fd < 0 && errno == EEXIST);  // left by a process with the same number that was killed
  if (fd < 0) fail_to_write(name, errno);
  Temporary temporary(std::move(chosen));
  int error = write_all(fd, bytes);
  if (error == 0 && existing && ::fchmod(fd, existing->st_mode & 07777) != 0) error = errno;
  if (::close(fd) != 0 && error == 0) error = errno;
  if (error == 0) error = temporary.rename_to(path);
  if (error != 0) fail_to_write(name, error);
}

}  // namespace

void write_file(const fs::path& path, std::string_view bytes) {
  if (path.empty())
    throw InvalidInput("the name of the file to write is empty; give one, or \"-\" for standard output");
  if (path == "-") {
    if (const int error = write_all(STDOUT_FILENO, bytes)) fail_to_write("standard output", error);
    return;
  }
  const fs::path target = behind_links(path);
  struct stat status {};
  const bool exists = ::stat(target.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) fail_to_write(path.string(), EISDIR);
  if (exists && (!S_ISREG(status.st_mode) || names_open_file(target))) return write_directly(target, bytes);
  replace_file(target, bytes, exists ? &status : nullptr);
}

}  // namespace evenmesh
