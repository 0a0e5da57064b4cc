/* SPDX-License-Identifier: MIT */
/*
 * stage.h: the raygrid scene that all plays in, and its twin: the same objects in the brute-force reference.
 *
 * All changes go through here, many at a time and read where they lie, so that both always hold the same and the time
 * that raygrid takes for them is taken in one place.
 */
#ifndef DEMO_STAGE_H
#define DEMO_STAGE_H

#include "handles.h"

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

/** An object as its owner keeps it. Arrays of these are what raygrid's views look into. */
struct Body {
    Form form;
    rg_pose pose;
    rg_object object = RG_NO_OBJECT;
};

/** How a stage is made. */
struct StageSetup {
    rg_grid_config grid;  /* of the scene's own grid */
    uint32_t workers = 0; /* 0: one a processor */
    bool twin = false;    /* whether rays will be checked against brute force */

    StageSetup() { check(rg_grid_config_default(&grid, sizeof grid)); }
};

class Stage {
  public:
    explicit Stage(const StageSetup &setup);

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
