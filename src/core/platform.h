#pragma once
/// What is asked of the operating system (POSIX), and nowhere else in the library: memory, files, plugins.
///
/// Errors come back as std::error_code; what they mean for the user is said by the caller, who knows whose file it is.

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>

namespace evenmesh {

/// Most memory that this process has held at once so far, bytes of RAM; 0 where the system does not tell.
/// Cost: a system call, about 1 µs.
std::size_t peak_memory_bytes() noexcept;

/// Folder of the program that runs; empty where the system does not tell.
std::filesystem::path program_folder();

/// Loads a library, which stays loaded until the process ends; all that it needs is found now or never.
/// @param name    a file, or a name without a folder that the system looks up ("libEGL.so.1")
/// @param reason  what the system says where it fails; untouched otherwise
/// @return a handle for find_symbol(), or null
void* load_library(const std::filesystem::path& name, std::string& reason);

/// What a loaded library calls by this name, or null.
void* find_symbol(void* library, const char* name) noexcept;

/// Bytes that are not zeroed before they are read into.
struct FileBytes {
  std::unique_ptr<char[]> data;
  std::size_t size = 0;
  std::string_view view() const { return {data.get(), size}; }
};

/// Reads a file, pipe or device to its end.
///
/// Guarantee: the bytes are a copy, so a file that shrinks or grows meanwhile does no harm. Folders are
/// std::errc::is_a_directory. Cost: O(bytes) time and memory; files of known size are read without a copy.
std::error_code read_to_end(const std::filesystem::path& path, FileBytes& bytes);
/// Standard input to its end.
std::error_code read_standard_input(FileBytes& bytes);

/// Writes all bytes, or says why not.
std::error_code write_standard_output(std::string_view bytes);
/// Writes into what is there: a device or a pipe, which must not be replaced by a file.
std::error_code write_into(const std::filesystem::path& path, std::string_view bytes);

/// Writes a file that appears under its name when it is complete: a temporary name in the same folder, then rename.
///
/// A file that is there keeps its permissions; one marked read-only is not replaced.
/// Guarantee: after an error, what was there is as before, and no temporary file is left. Not flushed to the disk: a
/// power failure may still lose it.
std::error_code replace_file(const std::filesystem::path& path, std::string_view bytes);

/// Whether this process may write to a file or into a folder that is there.
bool may_write(const std::filesystem::path& path) noexcept;

}  // namespace evenmesh
