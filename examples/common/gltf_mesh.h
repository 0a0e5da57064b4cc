/* SPDX-License-Identifier: MIT */
/* gltf_mesh.h: the triangles of glTF primitives, whatever their mode. */
#ifndef DEMO_GLTF_MESH_H
#define DEMO_GLTF_MESH_H

#include <Imath/ImathVec.h>
#include <cstdint>
#include <functional>
#include <string>
#include <tiny_gltf.h>
#include <vector>

namespace demo {

/** Receives what of a file is left out, and why. */
using Notes = std::function<void(const std::string &)>;

/** The triangles of a primitive. */
struct Surface {
    std::string name;                    /* for messages */
    std::vector<double> vertices;        /* x, y, z */
    std::vector<uint32_t> corners;       /* three a triangle */
    std::vector<Imath::V3f> normals;     /* one a vertex and each of length 1, or none at all */
    Imath::V3f colour{0.8f, 0.8f, 0.8f}; /* of the diffuse light that it reflects, linear */
    float gloss = 0;                     /* 0 to 1: how polished */
};

/**
 * Reads one primitive; no corners if it has no triangles, and a note says why. `where` names it in messages.
 * Indices and vertices are as the file has them: raygrid refuses those that are no vertex or not finite.
 * Throws std::runtime_error for accessors that are broken.
 */
Surface read_primitive(const tinygltf::Model &model, const tinygltf::Primitive &primitive, const std::string &where,
                       const Notes &notes);

} // namespace demo

#endif
