/* SPDX-License-Identifier: MIT */
/* hand.h: the user's hand: it sees what is under the mouse, and drags it in the picture's plane. */
#ifndef VIEWER_HAND_H
#define VIEWER_HAND_H

#include "camera.h"
#include "world.h"

namespace viewer {

/** What is seen at x, y of the picture: one ray. Its object is RG_NO_OBJECT if there is nothing. */
rg_hit look_at(rg_scene *scene, const demo::Camera &camera, double x, double y);

class Hand {
  public:
    /** Takes hold of what is at x, y; of nothing, if that is the sky or the ground. */
    void grab(World &world, const demo::Camera &camera, double x, double y);

    /** Brings what is held to x, y, at the same depth; true if that is elsewhere than it was. */
    bool drag(World &world, const demo::Camera &camera, double x, double y);

    /** Farther away by steps, or nearer. */
    void push(double steps);

    void let_go() { held_ = RG_NO_OBJECT; }
    rg_object held() const { return held_; }

  private:
    rg_object held_ = RG_NO_OBJECT;
    double depth_ = 0;     /* of the spot that was grabbed, along the camera's axis */
    Imath::V3d from_spot_; /* to the object's position */
    Imath::V3d position_;  /* of the object */
};

} // namespace viewer

#endif
