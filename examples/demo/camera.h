/* SPDX-License-Identifier: MIT */
/* camera.h: a perspective camera on a slow path around the model. */
#ifndef DEMO_CAMERA_H
#define DEMO_CAMERA_H

#include <Imath/ImathVec.h>
#include <cmath>
#include <cstdint>

namespace demo {

class Camera {
  public:
    /** `phase` from 0 to 1 along the path; a picture of width x height pixels. */
    Camera(double phase, uint32_t width, uint32_t height) {
        const double turn = 0.55 + 1.1 * phase, up = 1.55 - 0.1 * std::cos(2 * M_PI * phase), distance = 4.9;
        const Imath::V3d target(0, 0.17, 0);
        eye = Imath::V3d(distance * std::cos(turn), up, distance * std::sin(turn));
        forward = (target - eye).normalized();
        const double half = std::tan(0.5 * 38 * M_PI / 180); /* of the shorter side */
        const double pixel = 2 * half / std::fmin(width, height);
        right_ = forward.cross(Imath::V3d(0, 1, 0)).normalized() * pixel;
        down_ = -right_.cross(forward).normalized() * pixel;
        corner_ = forward - right_ * (width / 2.0) - down_ * (height / 2.0);
    }

    /** The direction through the point x, y of the picture, in pixels from its upper left corner; of length 1. */
    Imath::V3f direction(double x, double y) const {
        return Imath::V3f((corner_ + right_ * x + down_ * y).normalized());
    }

    Imath::V3d eye, forward;

  private:
    Imath::V3d right_, down_, corner_;
};

} // namespace demo

#endif
