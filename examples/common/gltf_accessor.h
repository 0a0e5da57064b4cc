/* SPDX-License-Identifier: MIT */
/* gltf_accessor.h: the numbers behind an accessor, with every offset, stride and count checked before it is used. */
#ifndef DEMO_GLTF_ACCESSOR_H
#define DEMO_GLTF_ACCESSOR_H

#include <cstdint>
#include <tiny_gltf.h>
#include <vector>

namespace demo {

/**
 * All elements of an accessor one after another, sparse ones in place, normalized integers as fractions.
 * Throws std::runtime_error that names the accessor, also if an element has not `components` components.
 */
std::vector<double> read_accessor(const tinygltf::Model &model, int accessor, int components);

/** The same for indices: scalars of an unsigned type. */
std::vector<uint32_t> read_indices(const tinygltf::Model &model, int accessor);

} // namespace demo

#endif
