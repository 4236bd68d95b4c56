#include "core/platform.h"

#include <dlfcn.h>
#include <sys/resource.h>
#include <unistd.h>

namespace evenmesh {

std::size_t peak_memory_bytes() noexcept {
  rusage usage{};
  if (::getrusage(RUSAGE_SELF, &usage) != 0) return 0;
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;  // Linux counts kilobytes
}

std::filesystem::path program_folder() {
  std::error_code unknown;
  return std::filesystem::read_symlink("/proc/self/exe", unknown).parent_path();
}

void* load_library(const std::filesystem::path& name, std::string& reason) {
  void* library = ::dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    const char* said = ::dlerror();
    reason = said != nullptr ? said : "unknown reason";
  }
  return library;
}

void* find_symbol(void* library, const char* name) noexcept {
  return ::dlsym(library, name);
}

bool may_write(const std::filesystem::path& path) noexcept {
  return ::access(path.c_str(), W_OK) == 0;
}

}  // namespace evenmesh
