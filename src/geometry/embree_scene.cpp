#include "geometry/embree_scene.h"

#include <cmath>

#include "core/parallel.h"
#include "evenmesh/error.h"

namespace evenmesh {
namespace {

/// One device for the process: it is immutable, and its own thread count is unused, since scenes are built in the arena
/// of whoever commits them.
RTCDevice shared_device() {
  static const std::shared_ptr<RTCDeviceTy> device(rtcNewDevice(nullptr), rtcReleaseDevice);
  return device.get();
}

void fill_vertices(RTCGeometry geometry, const Mesh& mesh, const EmbreeScene& scene, const ExecutionContext& context) {
  auto* to = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                         3 * sizeof(float), mesh.vertices.size()));
  parallel_for(context, mesh.vertices.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 local = scene.to_local(mesh.vertices[i]);
      for (int k = 0; k < 3; ++k) to[3 * i + k] = static_cast<float>(local[k]);
    }
  });
}

void fill_triangles(RTCGeometry geometry, const Mesh& mesh) {
  auto* to = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                 3 * sizeof(std::uint32_t), mesh.triangles.size()));
  for (const Triangle& t : mesh.triangles) to = std::copy(t.begin(), t.end(), to);
}

}  // namespace

EmbreeScene::EmbreeScene(const Mesh& mesh, const ExecutionContext& context) {
  if (mesh.triangles.empty()) throw InvalidInput("the mesh has no triangle to search; give one with at least one");
  const Box box = mesh.bounds();
  origin_ = box.center();
  // Small and large models alike must stay within the range of float; a power of two rounds nothing.
  const double diagonal = box.diagonal();
  if (diagonal > 0) scale_ = std::ldexp(1.0, -std::ilogb(diagonal));

  RTCDevice device = shared_device();
  scene_.reset(rtcNewScene(device), rtcReleaseScene);
  rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_LOW);
  const std::shared_ptr<RTCGeometryTy> geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE), rtcReleaseGeometry);
  with_threads(context, [&] {
    fill_vertices(geometry.get(), mesh, *this, context);
    fill_triangles(geometry.get(), mesh);
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometry(scene_.get(), geometry.get());
    rtcCommitScene(scene_.get());
  });
}

}  // namespace evenmesh
