/// After APPNOTE.TXT, the ZIP file format specification (PKWARE, version 6.3); the sections are named at the steps.

#include "io/zip.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <limits>

#include "evenmesh/error.h"
#include "io/binary.h"
#include "io/text.h"

namespace evenmesh {
namespace {

constexpr std::string_view local_mark("PK\3\4", 4), directory_mark("PK\1\2", 4), end_mark("PK\5\6", 4),
    end64_mark("PK\6\6", 4), locator_mark("PK\6\7", 4);
constexpr std::size_t local_size = 30, directory_size = 46, end_size = 22, end64_size = 56, locator_size = 20;
constexpr std::uint32_t in_extra_field = 0xffffffff;
/// Real 3MF packages unpack to less than 30 times their size; more is an attack on the memory.
constexpr std::uint64_t max_growth = 200, free_growth = 1 << 20;

template <typename Number>
Number field(std::string_view bytes, std::size_t at) {
  return load<Number>(bytes.data() + at);
}

/// §4.5.3: a zip64 extra field holds, in this order, those values that are all ones in the record itself.
void read_zip64(std::string_view extra, ZipArchive::Entry& entry) {
  while (extra.size() >= 4) {
    const std::size_t size = field<std::uint16_t>(extra, 2);
    if (extra.size() < 4 + size) return;
    if (field<std::uint16_t>(extra, 0) == 1) {
      std::string_view values = extra.substr(4, size);
      for (std::uint64_t* value : {&entry.size, &entry.packed_size, &entry.offset}) {
        if (*value != in_extra_field || values.size() < 8) continue;
        *value = field<std::uint64_t>(values, 0);
        values.remove_prefix(8);
      }
      return;
    }
    extra.remove_prefix(4 + size);
  }
}

}  // namespace

std::string_view ZipArchive::slice(std::uint64_t offset, std::uint64_t size) const {
  if (offset > source_.bytes.size() || size > source_.bytes.size() - offset) {
    fail(source_, "is a damaged zip archive: a part lies outside of the file; it may be truncated");
  }
  return source_.bytes.substr(offset, size);
}

ZipArchive::ZipArchive(const Source& source) : source_(source) {
  // §4.3.16: the end record lies in front of a comment of at most 65,535 bytes.
  const std::size_t from = source.bytes.size() - std::min<std::size_t>(source.bytes.size(), end_size + 0xffff);
  const std::size_t at = source.bytes.rfind(end_mark);
  if (at == std::string_view::npos || at < from || source.bytes.size() - at < end_size) {
    fail(source, "is a zip archive without its directory; the file is truncated");
  }
  std::uint64_t count = field<std::uint16_t>(source.bytes, at + 10),
                offset = field<std::uint32_t>(source.bytes, at + 16);
  if (at >= locator_size && source.bytes.substr(at - locator_size, 4) == locator_mark) {  // §4.3.15
    const std::string_view end64 = slice(field<std::uint64_t>(source.bytes, at - locator_size + 8), end64_size);
    if (end64.substr(0, 4) != end64_mark) fail(source, "is a damaged zip archive; copy or export it again");
    count = field<std::uint64_t>(end64, 32);
    offset = field<std::uint64_t>(end64, 48);
  }
  read_directory(offset, count);
}

void ZipArchive::read_directory(std::uint64_t offset, std::uint64_t count) {
  for (; count > 0; --count) {
    const std::string_view record = slice(offset, directory_size);
    if (record.substr(0, 4) != directory_mark) fail(source_, "has a damaged zip directory; copy or export it again");
    Entry entry;
    entry.flags = field<std::uint16_t>(record, 8);
    entry.method = field<std::uint16_t>(record, 10);
    entry.crc = field<std::uint32_t>(record, 16);
    entry.packed_size = field<std::uint32_t>(record, 20);
    entry.size = field<std::uint32_t>(record, 24);
    entry.offset = field<std::uint32_t>(record, 42);
    const std::uint64_t name = field<std::uint16_t>(record, 28), extra = field<std::uint16_t>(record, 30);
    entry.name = slice(offset + directory_size, name);
    read_zip64(slice(offset + directory_size + name, extra), entry);
    entries_.push_back(entry);
    offset += directory_size + name + extra + field<std::uint16_t>(record, 32);
  }
}

const ZipArchive::Entry* ZipArchive::find(std::string_view name) const {
  if (name.starts_with('/')) name.remove_prefix(1);
  std::string small(name);
  std::transform(small.begin(), small.end(), small.begin(), lower);
  for (const Entry& entry : entries_) {
    if (equals_ignoring_case(entry.name, small)) return &entry;
  }
  return nullptr;
}

std::string ZipArchive::extract(const Entry& entry) {
  const auto refuse = [&](std::string_view what) {
    fail(source_, fmt::format("part {} {}", quoted(entry.name), what));
  };
  if (entry.flags & 1) refuse("is encrypted; save the file without a password");
  const std::string_view local = slice(entry.offset, local_size);
  if (local.substr(0, 4) != local_mark) refuse("is damaged; copy or export the file again");
  const std::uint64_t start =
      entry.offset + local_size + field<std::uint16_t>(local, 26) + field<std::uint16_t>(local, 28);
  const std::string_view packed = slice(start, entry.packed_size);
  // Subtraction keeps the sum from overflowing, whatever size the directory claims.
  const std::uint64_t allowed = free_growth + max_growth * source_.bytes.size();
  if (entry.size > allowed - std::min(allowed, unpacked_)) {
    refuse(fmt::format("would unpack to {} bytes, more than {} times the file; it is damaged or meant to do harm",
                       entry.size, max_growth));
  }
  unpacked_ += entry.size;
  std::string bytes(entry.size, '\0');
  if (entry.method == 0) {
    if (packed.size() != entry.size) refuse("has two different sizes; copy or export the file again");
    bytes = packed;
  } else if (entry.method == Z_DEFLATED) {
    if (entry.size > std::numeric_limits<uInt>::max() || packed.size() > std::numeric_limits<uInt>::max()) {
      refuse("is larger than 4 GB; split it");
    }
    z_stream stream{};
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    stream.avail_in = static_cast<uInt>(packed.size());
    stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
    stream.avail_out = static_cast<uInt>(bytes.size());
    if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) throw UnusableInput("zlib cannot be started");
    const int result = inflate(&stream, Z_FINISH);
    inflateEnd(&stream);
    if (result != Z_STREAM_END || stream.avail_out != 0) refuse("cannot be unpacked; copy or export the file again");
  } else {
    refuse(fmt::format("is compressed by method {}, which is not available in this version; save it with deflate",
                       entry.method));
  }
  const auto crc = crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  if (crc != entry.crc) refuse("has a wrong checksum; copy or export the file again");
  return bytes;
}

namespace {

/// Raw deflate; level 4 packs coordinates about as well as the default level in half the time.
std::string deflated(std::string_view bytes) {
  z_stream stream{};
  if (deflateInit2(&stream, 4, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY) != Z_OK) {
    throw UnusableInput("zlib cannot be started");
  }
  std::string packed(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  deflate(&stream, Z_FINISH);
  packed.resize(packed.size() - stream.avail_out);
  deflateEnd(&stream);
  return packed;
}

}  // namespace

std::string zip_bytes(const std::vector<ZipPart>& parts) {
  std::string archive, directory;
  for (const ZipPart& part : parts) {
    if (part.bytes.size() > 0xf0000000u) throw UnusableInput("a 3MF file of more than 4 GB cannot be written; use PLY");
    const std::string packed = deflated(part.bytes);
    // §4.3.7: the record from "version needed" to "extra field length", which local header and directory share.
    ByteWriter common(26);
    common.put(std::uint16_t{20});
    common.put(std::uint16_t{0});
    common.put(std::uint16_t{Z_DEFLATED});
    common.put(std::uint16_t{0});                    // 00:00:00
    common.put(std::uint16_t{0 << 9 | 1 << 5 | 1});  // 1980-01-01, the earliest there is
    common.put(
        static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(part.bytes.data()), part.bytes.size())));
    common.put(static_cast<std::uint32_t>(packed.size()));
    common.put(static_cast<std::uint32_t>(part.bytes.size()));
    common.put(static_cast<std::uint16_t>(part.name.size()));
    common.put(std::uint16_t{0});
    const std::string shared = common.take();
    ByteWriter place(14);  // comment, volume, attributes: all zero; then the offset
    place.skip(10);
    place.put(static_cast<std::uint32_t>(archive.size()));
    directory.append(directory_mark).append("\x14\0", 2).append(shared).append(place.take()).append(part.name);
    archive.append(local_mark).append(shared).append(part.name).append(packed);
  }
  if (archive.size() > 0xf0000000u) throw UnusableInput("a 3MF file of more than 4 GB cannot be written; use PLY");
  ByteWriter end(end_size);
  end.put(end_mark);
  end.skip(4);
  end.put(static_cast<std::uint16_t>(parts.size()));
  end.put(static_cast<std::uint16_t>(parts.size()));
  end.put(static_cast<std::uint32_t>(directory.size()));
  end.put(static_cast<std::uint32_t>(archive.size()));
  end.skip(2);
  return archive + directory + end.take();
}

}  // namespace evenmesh
