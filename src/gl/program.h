#pragma once
/// Programs from shaders' texts.

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "evenmesh/error.h"
#include "gl/context.h"

namespace evenmesh::gl {

/// Names that shaders see as macros; so numbers that C++ and shaders share stand in one place.
using Constants = std::map<std::string, std::variant<std::int32_t, std::uint32_t, float, std::string>>;

enum class Stage { all, compute, vertex, fragment };

/// A shader does not compile or link.
class ShaderError : public UnusableInput {
 public:
  /// @param stage  the one that does not compile; all: they do not link
  ShaderError(const std::string& name, std::string log, Stage stage)
      : UnusableInput("the shader " + name + " does not compile on this driver: " + log),
        log_(std::move(log)),
        stage_(stage) {}
  const std::string& log() const { return log_; }  ///< the driver's words
  Stage stage() const { return stage_; }

 private:
  std::string log_;
  Stage stage_;
};

/// The version, the constants, and `text` with each line `#include "file.glsl"` replaced by that file of
/// src/gl/shaders; files may include others.
/// @throws UnusableInput  there is no such file, or it includes itself
std::string assemble_shader(std::string_view text, const Constants& constants = {});

/// A linked program. All but the destructor only within jobs.
class Program {
 public:
  Program() = default;
  /// Compute. @param text  as of assemble_shader(), complete
  /// @throws ShaderError
  static Program compute(std::shared_ptr<Context> context, const std::string& text, const std::string& name);
  /// Vertex and fragment.
  static Program drawing(std::shared_ptr<Context> context, const std::string& vertex, const std::string& fragment,
                         const std::string& name);
  ~Program();
  Program(Program&& other) noexcept { swap(other); }
  Program& operator=(Program&& other) noexcept {
    swap(other);
    return *this;
  }

  /// Uniforms by name; those that the shaders do not use are ignored.
  void set(const char* uniform, float value) const;
  void set(const char* uniform, std::int32_t value) const;
  void set(const char* uniform, std::uint32_t value) const;
  void set(const char* uniform, const std::array<float, 2>& value) const;
  void set(const char* uniform, const std::array<float, 3>& value) const;
  void set(const char* uniform, const std::array<float, 4>& value) const;
  /// Location of a vertex attribute; -1: the shaders do not use it.
  int attribute(const char* name) const;
  /// Columns first.
  void set_matrix(const char* uniform, const std::array<float, 16>& value) const;

  void use() const;
  /// Runs groups of a compute shader; what they write is visible to later passes. A step of the context.
  /// @param what  for errors: "the shader"
  void dispatch(std::string_view what, unsigned groups_x, unsigned groups_y = 1, unsigned groups_z = 1) const;

 private:
  static Program link(std::shared_ptr<Context> context, const std::map<unsigned, const std::string*>& stages,
                      const std::string& name);
  int location(const char* uniform) const;
  void swap(Program& other) noexcept {
    std::swap(context_, other.context_);
    std::swap(id_, other.id_);
  }

  std::shared_ptr<Context> context_;
  unsigned id_ = 0;
};

}  // namespace evenmesh::gl
