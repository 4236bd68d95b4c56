#include "gl/buffer.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>

#include "evenmesh/error.h"

namespace evenmesh::gl {

RawBuffer::RawBuffer(std::shared_ptr<Context> context, std::size_t bytes)
    : context_(std::move(context)), bytes_(std::max<std::size_t>(bytes, 4)) {
  if (bytes_ > context_->largest_block())
    throw UnusableInput(fmt::format("the graphics device takes at most {} MiB at once, and {} are needed; ask for less",
                                    context_->largest_block() >> 20, bytes_ >> 20));
  glCreateBuffers(1, &id_);
  glNamedBufferStorage(id_, static_cast<GLsizeiptr>(bytes_), nullptr, GL_DYNAMIC_STORAGE_BIT);
  try {
    context_->check("a buffer");
  } catch (...) {
    glDeleteBuffers(1, &id_);
    throw;
  }
}

RawBuffer::~RawBuffer() {
  if (id_ == 0) return;
  try {
    context_->run([&] { glDeleteBuffers(1, &id_); });
  } catch (const Error&) {
    // The context is lost, and the buffer with it.
  }
}

void RawBuffer::upload(std::span<const std::byte> bytes, std::size_t first) {
  if (first > bytes_ || bytes.size() > bytes_ - first) throw UnusableInput("a write behind the end of a buffer");
  if (bytes.empty()) return;
  glNamedBufferSubData(id_, static_cast<GLintptr>(first), static_cast<GLsizeiptr>(bytes.size()), bytes.data());
}

void RawBuffer::download(std::span<std::byte> bytes, std::size_t first) const {
  if (first > bytes_ || bytes.size() > bytes_ - first) throw UnusableInput("a read behind the end of a buffer");
  if (bytes.empty()) return;
  // First wait, in a step that may be given up; the copy into the caller's memory cannot be.
  context_->finish("the shader");
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glGetNamedBufferSubData(id_, static_cast<GLintptr>(first), static_cast<GLsizeiptr>(bytes.size()), bytes.data());
  context_->check("the shader");
}

void RawBuffer::fill_with_zeros() {
  glClearNamedBufferData(id_, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
}

void RawBuffer::bind(unsigned slot) const {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, slot, id_);
}

}  // namespace evenmesh::gl
