/* SPDX-License-Identifier: MIT */
/* swarm.h: spheres and boxes that drift outward in all directions, some of them leaving and others coming each frame.
 */
#ifndef DEMO_SWARM_H
#define DEMO_SWARM_H

#include "stage.h"

#include <Imath/ImathQuat.h>
#include <Imath/ImathRandom.h>
#include <Imath/ImathVec.h>

namespace demo {

/**
 * The box where all begins, and which the swarm drifts out of: the first physical box of the grid. The model lies
 * within a radius of 1 and rises when it is taken apart. Without it the box would be that of what is inserted first.
 */
constexpr double stage_lo[3] = {-2.8, -1, -2.8}, stage_hi[3] = {2.8, 1.4, 2.8};

/** The linear part of a pose: first stretched along the axes, then turned. */
void set_linear(rg_pose &pose, const Imath::Quatd &turn, const Imath::V3d &stretch);

class Swarm {
  public:
    struct Change {
        size_t inserted, removed;
    };

    /** `floor` is the height below which none starts. Nothing is inserted before start(). */
    Swarm(Stage &stage, bool boxes, size_t count, double floor, uint64_t seed);

    /** Inserts all, spread around the model within the stage. */
    void start();

    /** Lets a share of them vanish, as many appear, and all others drift on by `seconds`. */
    Change advance(double seconds);

    const std::vector<Body> &bodies() const { return bodies_; }

    /** Those of bodies() that the last call inserted: the last ones. */
    size_t fresh() const { return fresh_; }

  private:
    struct Motion {
        Imath::V3d velocity;
        Imath::V3d axis, stretch; /* boxes alone */
        double rate, angle;
    };

    void add(bool anywhere);

    Stage &stage_;
    const bool boxes_;
    const size_t count_;
    const double floor_;
    Imath::Rand48 random_;
    std::vector<Form> forms_;
    std::vector<Body> bodies_;
    std::vector<Motion> motions_; /* one a body */
    size_t fresh_ = 0;
};

} // namespace demo

#endif
