/// The OpenVDB plugin.

#include "io/vdb/plugin.h"

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <sstream>

namespace {

std::string serialize(const evenmesh::SparseVolume& volume) {
  openvdb::initialize();
  const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(volume.background);
  grid->setName(volume.name);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(volume.side));
  grid->transform().postTranslate({volume.origin.x, volume.origin.y, volume.origin.z});
  auto accessor = grid->getAccessor();
  for (std::size_t i = 0; i < volume.voxels.size(); ++i)
    accessor.setValue({volume.voxels[i][0], volume.voxels[i][1], volume.voxels[i][2]}, volume.values[i]);
  std::ostringstream out(std::ios::binary);
  openvdb::io::Stream(out).write({grid});
  return std::move(out).str();
}

}  // namespace

extern "C" bool evenmesh_vdb_serialize(const evenmesh::SparseVolume& volume, std::string& bytes) {
  try {
    bytes = serialize(volume);
    return true;
  } catch (const std::exception& error) {
    bytes = error.what();
    return false;
  }
}
