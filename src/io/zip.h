#pragma once
/// Zip archives, as far as 3MF packages need them: stored and deflated entries, zip64; no encryption, no volumes.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/source.h"

namespace evenmesh {

/// The directory of an archive in memory.
class ZipArchive {
 public:
  struct Entry {
    std::string_view name;
    std::uint64_t offset = 0, packed_size = 0, size = 0;
    std::uint32_t crc = 0;
    std::uint16_t method = 0, flags = 0;
  };

  /// @throws UnusableInput  truncated, or not a zip archive
  explicit ZipArchive(const Source& source);

  const std::vector<Entry>& entries() const { return entries_; }
  /// Entry by name: case of ASCII letters and a leading slash do not matter; nullptr if there is none.
  const Entry* find(std::string_view name) const;
  /// Unpacks and checks an entry.
  /// @throws UnusableInput  damaged, encrypted, of an unknown method, or unpacking to an implausible multiple of the
  /// file
  std::string extract(const Entry& entry);

 private:
  void read_directory(std::uint64_t offset, std::uint64_t count);
  std::string_view slice(std::uint64_t offset, std::uint64_t size) const;

  Source source_;
  std::vector<Entry> entries_;
  std::uint64_t unpacked_ = 0;
};

/// A part to be written into an archive.
struct ZipPart {
  std::string_view name, bytes;
};
/// Bytes of an archive with deflated entries and no time stamps: the same parts give the same bytes.
std::string zip_bytes(const std::vector<ZipPart>& parts);

}  // namespace evenmesh
