/* SPDX-License-Identifier: MIT */
/* handles.h: raygrid's handles and results in C++ terms: owned by unique_ptr, failures thrown. */
#ifndef DEMO_HANDLES_H
#define DEMO_HANDLES_H

#include <memory>
#include <raygrid/raygrid.h>
#include <stdexcept>
#include <string>

namespace demo {

struct SceneEnd {
    void operator()(rg_scene *scene) const { rg_scene_destroy(&scene); }
};
struct ShapeEnd {
    void operator()(rg_shape *shape) const { rg_shape_release(&shape); }
};
using ScenePointer = std::unique_ptr<rg_scene, SceneEnd>;
using ShapePointer = std::unique_ptr<rg_shape, ShapeEnd>;

inline void check(rg_result result) {
    if (result != RG_OK) throw std::runtime_error(std::string(rg_result_name(result)) + ": " + rg_error_message());
}

} // namespace demo

#endif
