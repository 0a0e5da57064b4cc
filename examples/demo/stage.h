/* SPDX-License-Identifier: MIT */
/*
 * stage.h: the raygrid scene that the demo plays in, and its twin: the same objects in the brute-force reference.
 *
 * All changes go through here, many at a time and read where they lie, so that both always hold the same and the time
 * that raygrid takes for them is taken in one place.
 */
#ifndef DEMO_STAGE_H
#define DEMO_STAGE_H

#include "handles.h"
#include "options.h"

#include <stdbool.h>
#include <vector>

extern "C" {
#include <reference.h>
}

namespace demo {

/** A shape in both worlds; belongs to the stage. `twin` is NULL if there is no reference. */
struct Form {
    rg_shape *shape;
    const reference_shape *twin;
};

/** An object as the demo keeps it. Arrays of these are what raygrid's views look into. */
struct Body {
    Form form;
    rg_pose pose;
    rg_object object = RG_NO_OBJECT;
};

/**
 * The box where all begins, and which the swarm drifts out of: the first physical box of the grid. The model lies
 * within a radius of 1 and rises when it is taken apart. Without it the box would be that of what is inserted first.
 */
constexpr double stage_lo[3] = {-2.8, -1, -2.8}, stage_hi[3] = {2.8, 1.4, 2.8};

class Stage {
  public:
    /** With a twin if any ray is to be checked. */
    explicit Stage(const Options &options);

    Form sphere(double radius);
    Form box(const double lo[3], const double hi[3]);
    /** x, y, z of each vertex; three corners a triangle. Throws with raygrid's message if they are no mesh. */
    Form mesh(const std::vector<double> &vertices, const std::vector<uint32_t> &corners);

    /** Inserts bodies and stores their ids in them. */
    void insert(Body *bodies, size_t count);
    /** Moves bodies to the poses they have now; `turned` false: only their positions have changed. */
    void move(const Body *bodies, size_t count, bool turned);
    void remove(const Body *bodies, size_t count);

    rg_scene *scene() const { return scene_.get(); }
    const reference_scene *twin() const { return twin_.get(); }

    /** Seconds that raygrid took for changes since the last call of this. */
    double take_seconds();

  private:
    struct TwinEnd {
        void operator()(reference_scene *scene) const { reference_destroy(scene); }
    };
    Form own(rg_shape *shape, const reference_shape *twin);

    ScenePointer scene_;
    std::unique_ptr<reference_scene, TwinEnd> twin_;
    std::vector<ShapePointer> shapes_;
    double seconds_ = 0;
};

} // namespace demo

#endif
