/* SPDX-License-Identifier: MIT */
#include "world.h"

#include <cmath>

namespace demo {

namespace {

constexpr double frame_seconds = 1.0 / 24;

/* Linear reflectances: warm ones, so that the engine's white, blue and turquoise stand out among them. */
const Imath::V3f palette[] = {
    {0.80f, 0.17f, 0.03f}, {0.80f, 0.32f, 0.04f}, {0.62f, 0.47f, 0.30f},
    {0.55f, 0.06f, 0.05f}, {0.78f, 0.72f, 0.62f}, {0.10f, 0.09f, 0.10f},
};

} // namespace

World::World(const Model &model, const Options &options, Notes notes)
    : model_(model), options_(options), notes_(std::move(notes)), stage_(options),
      parts_(model, stage_, options.seed), spheres_(stage_, false, options.spheres, parts_.floor(), options.seed),
      boxes_(stage_, true, options.boxes, parts_.floor(), options.seed) {}

void World::set_look(rg_object object, const Look &look) {
    const uint32_t slot = RG_OBJECT_SLOT(object);
    if (slot >= looks_.size()) looks_.resize(slot + size_t(1));
    looks_[slot] = look;
}

void World::start(Update &update) {
    spheres_.start();
    boxes_.start();
    /* Infinite, so it is one that no cell holds; a little below the model, which would else lie in its surface. */
    const double infinity = HUGE_VAL, lo[3] = {-infinity, -1, -infinity}, hi[3] = {infinity, 0, infinity};
    Body ground;
    ground.form = stage_.box(lo, hi);
    ground.pose = rg_pose_at(0, parts_.floor() - 0.01, 0);
    stage_.insert(&ground, 1);
    Look look;
    look.kind = Look::Kind::Ground;
    look.colour = {0.085f, 0.105f, 0.135f};
    set_look(ground.object, look);
    update.inserted += spheres_.bodies().size() + boxes_.bodies().size() + 1;
}

void World::paint_swarm(const Swarm &swarm) {
    const std::vector<Body> &bodies = swarm.bodies();
    for (size_t i = bodies.size() - swarm.fresh(); i < bodies.size(); ++i) {
        /* The id's own digits decide: the colour stays with the object. */
        uint64_t mixed = bodies[i].object * 0x9E3779B97F4A7C15u;
        Look look;
        look.colour = palette[(mixed >> 40) % (sizeof palette / sizeof *palette)];
        look.gloss = 0.5f;
        set_look(bodies[i].object, look);
    }
}

void World::paint_parts() {
    for (size_t i = 0; i < parts_.bodies().size(); ++i) {
        const Body &body = parts_.bodies()[i];
        if (body.object == RG_NO_OBJECT) continue;
        const Surface &surface = model_.surfaces()[model_.parts()[i].surface];
        Look look;
        look.colour = surface.colour;
        look.gloss = std::max(surface.gloss, 0.35f);
        look.surface = surface.normals.empty() ? nullptr : &surface;
        const float *m = body.pose.linear;
        /* For row vectors a normal goes by the inverse of the linear part for column vectors. */
        look.normals = Imath::M33f(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8]).inverse();
        set_look(body.object, look);
    }
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
    paint_parts();
    return update;
}

} // namespace demo
