/* SPDX-License-Identifier: MIT */
/* world.h: all that moves and the ground below, frame by frame, and how each object looks. */
#ifndef DEMO_WORLD_H
#define DEMO_WORLD_H

#include "parts.h"
#include "swarm.h"

namespace demo {

/** How an object reflects light. */
struct Look {
    enum class Kind { Plain, Ground } kind = Kind::Plain;
    Imath::V3f colour{0.8f, 0.8f, 0.8f};
    float gloss = 0;
    const Surface *surface = nullptr; /* for smooth normals; NULL: the geometric ones do */
    Imath::M33f normals;              /* takes normals of the surface to the world, for row vectors */
};

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
    const Look &look(rg_object object) const { return looks_[RG_OBJECT_SLOT(object)]; }

  private:
    void start(Update &update);
    void set_look(rg_object object, const Look &look);
    void paint_parts();
    void paint_swarm(const Swarm &swarm);

    const Model &model_;
    const Options options_;
    const Notes notes_;
    Stage stage_;
    Parts parts_;
    Swarm spheres_, boxes_;
    std::vector<Look> looks_; /* by slot */
    uint32_t frame_ = 0;
};

} // namespace demo

#endif
