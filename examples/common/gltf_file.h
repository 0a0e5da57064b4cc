/* SPDX-License-Identifier: MIT */
/* gltf_file.h: from a path to tinygltf's view of a glTF file. */
#ifndef DEMO_GLTF_FILE_H
#define DEMO_GLTF_FILE_H

#include "gltf_mesh.h"

namespace demo {

/**
 * Reads a .gltf or .glb file, told apart by what is in it; images are not decoded. Throws std::runtime_error if the
 * file can't be read, is no glTF 2, has a property of the wrong type, lacks a buffer, or needs an extension that
 * changes what the geometry is. Indices and ranges inside are not checked yet.
 */
tinygltf::Model load_gltf(const std::string &path, const Notes &notes);

} // namespace demo

#endif
