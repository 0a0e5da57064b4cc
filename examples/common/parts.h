/* SPDX-License-Identifier: MIT */
/* parts.h: the parts of the glTF model, which plays its animations and is taken apart and put together again. */
#ifndef DEMO_PARTS_H
#define DEMO_PARTS_H

#include "gltf_model.h"
#include "look.h"

#include <Imath/ImathBox.h>

namespace demo {

class Parts {
  public:
    struct Change {
        size_t inserted, removed;
    };

    /**
     * Makes the shapes; nothing is inserted before the first advance(). The model is scaled and shifted so that it
     * lies within a radius of 1 around the origin. Throws std::runtime_error if it has no extent.
     */
    Parts(const Model &model, Stage &stage, uint64_t seed);

    /**
     * Brings the parts to where they are at `phase`, from 0 to 1: at both ends the model is whole. A part whose
     * transform can't be inverted is not in the scene while that lasts; the first time it goes to `notes`.
     */
    Change advance(double phase, const Notes &notes);

    /** Tells how those look that are in the scene; again after each advance(), as smooth normals turn with them. */
    void paint(Looks &looks) const;

    /** Takes a part out of the play, for good, if the object is one: it stays where it is. */
    bool release(rg_object object);

    /** The lowest point of the whole model. */
    double floor() const { return floor_; }

  private:
    /* How the parts of one node fly. */
    struct Flight {
        Imath::V3d centre; /* at rest */
        Imath::V3d away;   /* where to, from rest */
        Imath::V3d axis;
        double turn;  /* radians, when farthest */
        double delay; /* 0 to 1: who starts late comes back early */
    };

    void plan(const std::vector<Imath::Box3d> &boxes, uint64_t seed);
    Imath::M44d flight(size_t node, double phase) const;
    Change update_presence(const std::vector<bool> &present);
    Look look_of(size_t part) const;

    const Model &model_;
    Stage &stage_;
    Imath::M44d to_stage_;        /* from the model's world to the stage's */
    std::vector<Flight> flights_; /* one a node; unused for nodes without parts */
    std::vector<Body> bodies_;    /* one a part of the model */
    std::vector<bool> told_, released_;
    double floor_ = -1;
};

} // namespace demo

#endif
