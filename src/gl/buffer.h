#pragma once
/// Arrays in the device's memory.

#include <cstddef>
#include <memory>
#include <span>
#include <utility>

#include "gl/context.h"

namespace evenmesh::gl {

/// Bytes in a storage buffer. All but the destructor only within jobs.
class RawBuffer {
 public:
  RawBuffer() = default;
  /// Content is undefined.
  /// @throws UnusableInput  larger than shaders may see (Context::largest_block(), 128 MiB on llvmpipe); no memory left
  RawBuffer(std::shared_ptr<Context> context, std::size_t bytes);
  ~RawBuffer();
  RawBuffer(RawBuffer&& other) noexcept { swap(other); }
  RawBuffer& operator=(RawBuffer&& other) noexcept {
    swap(other);
    return *this;
  }

  void upload(std::span<const std::byte> bytes, std::size_t first);
  /// Waits until the device has done everything.
  void download(std::span<std::byte> bytes, std::size_t first) const;
  void fill_with_zeros();
  void bind(unsigned slot) const;
  unsigned id() const { return id_; }

 private:
  void swap(RawBuffer& other) noexcept {
    std::swap(context_, other.context_);
    std::swap(id_, other.id_);
    std::swap(bytes_, other.bytes_);
  }

  std::shared_ptr<Context> context_;
  unsigned id_ = 0;
  std::size_t bytes_ = 0;
};

/// `size` values of T, laid out as shaders see them in std430 (so: no vec3). All but the destructor only within jobs.
template <typename T>
class Buffer {
 public:
  Buffer() = default;
  /// @throws as RawBuffer
  Buffer(std::shared_ptr<Context> context, std::size_t size)
      : raw_(std::move(context), size * sizeof(T)), size_(size) {}

  std::size_t size() const { return size_; }
  /// Writes from the element `first` on. @throws UnusableInput if that is not within the buffer
  void upload(std::span<const T> values, std::size_t first = 0) {
    raw_.upload(std::as_bytes(values), first * sizeof(T));
  }
  /// Reads from the element `first` on; waits until the device has done everything.
  void download(std::span<T> values, std::size_t first = 0) const {
    raw_.download(std::as_writable_bytes(values), first * sizeof(T));
  }
  void fill_with_zeros() { raw_.fill_with_zeros(); }
  /// As `layout(std430, binding = slot) buffer`.
  void bind(unsigned slot) const { raw_.bind(slot); }
  unsigned id() const { return raw_.id(); }

 private:
  RawBuffer raw_;
  std::size_t size_ = 0;
};

}  // namespace evenmesh::gl
