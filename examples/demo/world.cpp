/* SPDX-License-Identifier: MIT */
#include "world.h"

#include <algorithm>

namespace demo {

namespace {

constexpr double frame_seconds = 1.0 / 24;

StageSetup setup_of(const Options &options) {
    StageSetup setup;
    setup.grid.kind = options.grid;
    std::copy_n(stage_lo, 3, setup.grid.lo);
    std::copy_n(stage_hi, 3, setup.grid.hi);
    setup.workers = options.workers;
    setup.twin = options.sample > 0;
    return setup;
}

} // namespace

World::World(const Model &model, const Options &options, Notes notes)
    : options_(options), notes_(std::move(notes)), stage_(setup_of(options)), parts_(model, stage_, options.seed),
      spheres_(stage_, false, options.spheres, parts_.floor(), options.seed),
      boxes_(stage_, true, options.boxes, parts_.floor(), options.seed) {}

void World::start(Update &update) {
    spheres_.start();
    boxes_.start();
    /* Infinite, so it is one that no cell holds; a little below the model, which would else lie in its surface. */
    insert_ground(stage_, looks_, parts_.floor() - 0.01);
    update.inserted += spheres_.bodies().size() + boxes_.bodies().size() + 1;
}

void World::paint_swarm(const Swarm &swarm) {
    const std::vector<Body> &bodies = swarm.bodies();
    for (size_t i = bodies.size() - swarm.fresh(); i < bodies.size(); ++i)
        looks_.set(bodies[i].object, look_by_id(bodies[i].object));
}

World::Update World::advance() {
    Update update = {0, 0, 0};
    if (frame_ == 0) {
        start(update);
    } else {
        for (Swarm *swarm : {&spheres_, &boxes_}) {
            const Swarm::Change change = swarm->advance(frame_seconds);
            update.inserted += change.inserted;
            update.removed += change.removed;
        }
    }
    const Parts::Change change = parts_.advance(double(frame_) / options_.frames, notes_);
    update.inserted += change.inserted;
    update.removed += change.removed;
    update.seconds = stage_.take_seconds();
    ++frame_;
    paint_swarm(spheres_);
    paint_swarm(boxes_);
    parts_.paint(looks_);
    return update;
}

} // namespace demo
