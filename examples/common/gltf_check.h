/* SPDX-License-Identifier: MIT */
/* gltf_check.h: whether a text is glTF 2 that can be read here, and every property that matters has its type. */
#ifndef DEMO_GLTF_CHECK_H
#define DEMO_GLTF_CHECK_H

#include <string>

namespace demo {

/**
 * Throws std::runtime_error with the place and what is wrong there, such as "nodes[3].children is not an array of
 * indices"; also for another version than 2, and for required extensions that change the geometry. tinygltf takes a
 * property of the wrong type as not given, and recurses as deep as the text does; both end here. Whether an index has
 * a target is for those to say who follow it.
 */
void check_gltf_json(const char *text, size_t size);

} // namespace demo

#endif
