#pragma once
/// Numbers in bytes, of either byte order. Hosts are little-endian.

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace evenmesh {

static_assert(std::endian::native == std::endian::little, "readers and writers assume a little-endian host");

/// Loads a number from unaligned bytes.
template <typename Number>
Number load(const char* bytes, bool swap = false) {
  char copy[sizeof(Number)];
  std::memcpy(copy, bytes, sizeof(Number));
  if (swap) std::reverse(copy, copy + sizeof(Number));
  return std::bit_cast<Number>(copy);
}

/// Fills a string of known size from the front.
class ByteWriter {
 public:
  explicit ByteWriter(std::size_t size) : bytes_(size, '\0'), at_(bytes_.data()) {}
  template <typename Number>
  requires std::is_arithmetic_v<Number>
  void put(Number value) {
    std::memcpy(at_, &value, sizeof value);
    at_ += sizeof value;
  }
  void put(std::string_view text) {
    std::copy(text.begin(), text.end(), at_);
    at_ += text.size();
  }
  void skip(std::size_t count) { at_ += count; }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
  char* at_;
};

}  // namespace evenmesh
