#pragma once
/// What both readers of scenes share: files beside the scene, the budget, how shapes are placed.

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "evenmesh/execution_context.h"
#include "evenmesh/scene.h"
#include "evenmesh/solid.h"
#include "io/source.h"

namespace evenmesh {

/// Where shapes of one scene come from. Throws UnusableInput without the scene's name; readers add it, and the place.
class SceneLoader {
 public:
  SceneLoader(std::filesystem::path folder, const SceneLimits& limits, ExecutionContext& context)
      : folder_(std::move(folder)), left_(limits.triangles), context_(context) {}

  /// The solid in a mesh file, or the surface of a point file; read once however often it is asked for.
  /// @param name  relative to the scene's folder, or absolute
  /// Meshes in another unit than the scene are converted; where the scene names none, the first mesh that has one does.
  Shape mesh_file(const std::string& name);
  Shape point_file(const std::string& name);
  Shape dexel_file(const std::string& name);
  /// The solid of a shader file.
  Shape shader_file(const std::string& name, const GlslOptions& options) const;
  /// The solid that two shader files draw; "default" is none.
  Shape raster_files(const std::string& vertex, const std::string& fragment, RasterOptions options) const;

  /// The shape moved; `placement` nullptr: where it is.
  Shape placed(const Shape& shape, const Affine* placement);

  /// Triangles or points about to be made. A few bytes could otherwise ask for more than fits into any memory.
  void spend(std::uint64_t count);

  ExecutionContext& run() const { return context_; }
  std::optional<LengthUnit> unit() const { return unit_; }
  void set_unit(LengthUnit unit) { unit_ = unit; }

 private:
  std::filesystem::path file(const std::string& name) const;
  Shape in_scene_unit(Shape shape);
  /// What read(path, title) makes of a file, the first time it is asked for.
  template <typename Read>
  Shape once(std::map<std::filesystem::path, Shape>& known, const std::string& name, const Read& read);

  std::filesystem::path folder_;
  std::uint64_t left_;
  ExecutionContext& context_;
  std::optional<LengthUnit> unit_;
  std::map<std::filesystem::path, Shape> meshes_, points_, dexels_;
};

/// Reads a JSON scene. @throws UnusableInput, NotAvailable
Shape read_json_scene(const Source& source, SceneLoader& loader, const SceneLimits& limits);
/// Reads an OpenSCAD .csg file. @throws UnusableInput
Shape read_csg_scene(const Source& source, SceneLoader& loader, const SceneLimits& limits);

}  // namespace evenmesh
