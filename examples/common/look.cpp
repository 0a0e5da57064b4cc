/* SPDX-License-Identifier: MIT */
#include "look.h"

#include <cmath>

namespace demo {

namespace {

/* Linear reflectances: warm ones, so that the engine's white, blue and turquoise stand out among them. */
const Imath::V3f palette[] = {
    {0.80f, 0.17f, 0.03f}, {0.80f, 0.32f, 0.04f}, {0.62f, 0.47f, 0.30f},
    {0.55f, 0.06f, 0.05f}, {0.78f, 0.72f, 0.62f}, {0.10f, 0.09f, 0.10f},
};

} // namespace

Look look_by_id(rg_object object) {
    const uint64_t mixed = object * 0x9E3779B97F4A7C15u;
    Look look;
    look.colour = palette[(mixed >> 40) % (sizeof palette / sizeof *palette)];
    look.gloss = 0.5f;
    return look;
}

rg_object insert_ground(Stage &stage, Looks &looks, double height) {
    const double infinity = HUGE_VAL, lo[3] = {-infinity, -1, -infinity}, hi[3] = {infinity, 0, infinity};
    Body ground;
    ground.form = stage.box(lo, hi);
    ground.pose = rg_pose_at(0, height, 0);
    stage.insert(&ground, 1);
    Look look;
    look.kind = Look::Kind::Ground;
    look.colour = {0.085f, 0.105f, 0.135f};
    looks.set(ground.object, look);
    return ground.object;
}

} // namespace demo
