/* SPDX-License-Identifier: MIT */
/* world.h: all that moves and the ground below, frame by frame, and how each object looks. */
#ifndef DEMO_WORLD_H
#define DEMO_WORLD_H

#include "options.h"
#include "parts.h"
#include "swarm.h"

namespace demo {

class World {
  public:
    World(const Model &model, const Options &options, Notes notes);

    struct Update {
        double seconds; /* that raygrid took */
        size_t inserted, removed;
    };

    /** Makes the world of the next frame: the first call inserts everything, all others change it. */
    Update advance();

    Stage &stage() { return stage_; }
    const Stage &stage() const { return stage_; }
    const Looks &looks() const { return looks_; }

  private:
    void start(Update &update);
    void paint_swarm(const Swarm &swarm);

    const Options options_;
    const Notes notes_;
    Stage stage_;
    Parts parts_;
    Swarm spheres_, boxes_;
    Looks looks_;
    uint32_t frame_ = 0;
};

} // namespace demo

#endif
