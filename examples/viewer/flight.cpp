/* SPDX-License-Identifier: MIT */
#include "flight.h"

#include <algorithm>
#include <cmath>

namespace viewer {

using Imath::V3d;

namespace {

constexpr double speed = 1.2;       /* units a second; what is shown lies within a radius of one or some */
constexpr double hurry = 4;         /* times faster */
constexpr double per_pixel = 0.004; /* radians */
constexpr double steepest = 1.5;    /* radians; the camera's own up must not be its forward */

struct Way {
    SDL_Keycode key;
    double right, up, ahead;
};
const Way ways[] = {{SDLK_w, 0, 0, 1}, {SDLK_s, 0, 0, -1}, {SDLK_a, -1, 0, 0},
                    {SDLK_d, 1, 0, 0}, {SDLK_e, 0, 1, 0},  {SDLK_q, 0, -1, 0}};

} // namespace

Flight::Flight(const V3d &eye, const V3d &target) : first_eye_(eye), first_target_(target) {
    go_home();
}

bool Flight::flies_by(SDL_Keycode key) {
    const bool way = std::any_of(std::begin(ways), std::end(ways), [key](const Way &w) { return w.key == key; });
    return way || key == SDLK_LSHIFT || key == SDLK_RSHIFT;
}

void Flight::go_home() {
    const V3d ahead = (first_target_ - first_eye_).normalized();
    eye_ = first_eye_;
    heading_ = std::atan2(ahead.x, -ahead.z);
    rise_ = std::clamp(std::asin(ahead.y), -steepest, steepest);
    turned_ = true;
}

V3d Flight::forward() const {
    return {std::sin(heading_) * std::cos(rise_), std::sin(rise_), -std::cos(heading_) * std::cos(rise_)};
}

void Flight::turn(double x, double y) {
    heading_ += x * per_pixel;
    rise_ = std::clamp(rise_ - y * per_pixel, -steepest, steepest);
    turned_ = true;
}

bool Flight::advance(double seconds) {
    const V3d ahead = forward(), right = ahead.cross(V3d(0, 1, 0)).normalized();
    V3d way(0);
    for (const Way &w : ways)
        if (held_.count(w.key)) way += right * w.right + V3d(0, w.up, 0) + ahead * w.ahead;
    const bool moved = turned_ || way.length() > 0;
    const bool fast = held_.count(SDLK_LSHIFT) || held_.count(SDLK_RSHIFT);
    eye_ += way * (speed * (fast ? hurry : 1) * seconds);
    turned_ = false;
    return moved;
}

demo::Camera Flight::camera(uint32_t width, uint32_t height) const {
    return demo::Camera(eye_, eye_ + forward(), width, height);
}

} // namespace viewer
