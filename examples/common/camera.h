/* SPDX-License-Identifier: MIT */
/* camera.h: a perspective camera. Up is +y. */
#ifndef DEMO_CAMERA_H
#define DEMO_CAMERA_H

#include <Imath/ImathVec.h>
#include <cmath>
#include <cstdint>

namespace demo {

class Camera {
  public:
    /** At `from`, looking at `target`, which is not straight above or below; a picture of width x height pixels. */
    Camera(const Imath::V3d &from, const Imath::V3d &target, uint32_t width, uint32_t height)
        : eye(from), forward((target - from).normalized()), middle_(width / 2.0, height / 2.0) {
        const double half = std::tan(0.5 * 38 * M_PI / 180); /* of the shorter side */
        const double pixel = 2 * half / std::fmin(width, height);
        right_ = forward.cross(Imath::V3d(0, 1, 0)).normalized() * pixel;
        down_ = -right_.cross(forward).normalized() * pixel;
        corner_ = forward - right_ * middle_.x - down_ * middle_.y;
    }

    /** The direction through the point x, y of the picture, in pixels from its upper left corner; of length 1. */
    Imath::V3f direction(double x, double y) const { return Imath::V3f(to(x, y).normalized()); }

    /** The place at x, y of the picture and `depth` along the axis. */
    Imath::V3d place(double x, double y, double depth) const { return eye + to(x, y) * depth; }

    /** The inverse of place(): x, y and depth of a point; x and y mean something where the depth is positive. */
    Imath::V3d project(const Imath::V3d &point) const {
        const Imath::V3d away = point - eye;
        const double depth = away.dot(forward);
        return {away.dot(right_) / (right_.length2() * depth) + middle_.x,
                away.dot(down_) / (down_.length2() * depth) + middle_.y, depth};
    }

    Imath::V3d eye, forward;

  private:
    /* Of length 1 along the axis. */
    Imath::V3d to(double x, double y) const { return corner_ + right_ * x + down_ * y; }

    Imath::V2d middle_;
    Imath::V3d right_, down_, corner_;
};

} // namespace demo

#endif
