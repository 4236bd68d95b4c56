#pragma once
/// Whole files in memory.

#include <filesystem>
#include <string>

#include "core/platform.h"

namespace evenmesh {

/// Reads a whole file, pipe or device; "-" is standard input.
///
/// Guarantee: the bytes are a copy, so a file that shrinks meanwhile does no harm. Cost: O(bytes) time and memory.
/// @throws UnusableInput  one sentence with the file's name: it does not exist, is a directory, may not be read, …
FileBytes load_file(const std::filesystem::path& path);

/// What messages call a path: itself, or "standard input" for "-".
std::string name_of_input(const std::filesystem::path& path);

}  // namespace evenmesh
