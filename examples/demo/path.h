/* SPDX-License-Identifier: MIT */
/* path.h: the slow path of the demo's camera around the model. */
#ifndef DEMO_PATH_H
#define DEMO_PATH_H

#include "camera.h"

namespace demo {

/** `phase` from 0 to 1 along the path; a picture of width x height pixels. */
inline Camera camera_on_path(double phase, uint32_t width, uint32_t height) {
    const double turn = 0.55 + 1.1 * phase, up = 1.55 - 0.1 * std::cos(2 * M_PI * phase), distance = 4.9;
    const Imath::V3d eye(distance * std::cos(turn), up, distance * std::sin(turn));
    return Camera(eye, Imath::V3d(0, 0.17, 0), width, height);
}

} // namespace demo

#endif
