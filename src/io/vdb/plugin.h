#pragma once
/// What the OpenVDB plugin offers. It is a library of its own, loaded when it is needed: OpenVDB takes 30 ms and 27 MB
/// to load, which everybody else would pay for.

#include <string>

#include "evenmesh/volume.h"

namespace evenmesh::vdb {

/// Writes the bytes of a file to `bytes`; returns false and a sentence there when it fails.
using Serialize = bool(const SparseVolume& volume, std::string& bytes);
inline constexpr const char* serialize_name = "evenmesh_vdb_serialize";
inline constexpr const char* plugin_name = "evenmesh_vdb.so";

}  // namespace evenmesh::vdb
