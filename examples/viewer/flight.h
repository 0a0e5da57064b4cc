/* SPDX-License-Identifier: MIT */
/* flight.h: the camera, flown by keys and turned by the mouse. */
#ifndef VIEWER_FLIGHT_H
#define VIEWER_FLIGHT_H

#include "camera.h"

#include <SDL_keycode.h>
#include <set>

namespace viewer {

class Flight {
  public:
    Flight(const Imath::V3d &eye, const Imath::V3d &target);

    /** Whether a key is one of those that it flies by: they work as long as they are held. */
    static bool flies_by(SDL_Keycode key);
    void press(SDL_Keycode key) { held_.insert(key); }
    void release(SDL_Keycode key) { held_.erase(key); }
    void release_all() { held_.clear(); }

    /** Turns by a way of the mouse, in pixels. */
    void turn(double x, double y);

    /** Back to where it began. */
    void go_home();

    /** Flies on by `seconds`; true if the camera is not where it was at the last call. */
    bool advance(double seconds);

    demo::Camera camera(uint32_t width, uint32_t height) const;

  private:
    Imath::V3d forward() const;

    const Imath::V3d first_eye_, first_target_;
    Imath::V3d eye_;
    double heading_ = 0, rise_ = 0; /* radians, around the vertical and up */
    std::set<SDL_Keycode> held_;
    bool turned_ = false;
};

} // namespace viewer

#endif
