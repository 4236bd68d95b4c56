#pragma once
/// Compute shaders that take points to numbers.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "gl/buffer.h"
#include "gl/context.h"
#include "gl/program.h"
#include "shape/field.h"

namespace evenmesh::gl {

/// A compute shader with groups of `group` invocations along x that reads em_count points (binding 0: all x, all y, all
/// z) and writes rows of em_count floats (binding 1). If it finds a loop without end, it writes a number above 0 to the
/// one uint of binding 2. All but the destructor only within jobs.
///
/// Dispatches begin small and grow to about a quarter of a second each.
class PointProgram {
 public:
  static constexpr std::uint32_t group = 64;

  PointProgram() = default;
  /// @param text  as of assemble_shader(), complete
  /// @throws ShaderError
  PointProgram(std::shared_ptr<Context> context, const std::string& text, const std::string& name);

  const Program& program() const { return program_; }

  /// One span of `values` for each row, as long as the points.
  /// @param layers  groups along y
  /// @return the number that the shader left in binding 2, after which nothing more was done; 0 if all is well
  std::uint32_t run(const PointBatch& points, unsigned layers, std::span<const std::span<float>> values);

 private:
  void reserve(std::size_t points, std::size_t values);
  void learn(std::size_t values, double seconds);

  std::shared_ptr<Context> context_;
  std::string what_;  ///< for errors
  Program program_{};
  Buffer<float> points_{}, values_{};
  Buffer<std::uint32_t> late_{};
  std::size_t chunk_ = 4096;  ///< values that the next dispatch may take
};

}  // namespace evenmesh::gl
