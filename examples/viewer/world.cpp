/* SPDX-License-Identifier: MIT */
#include "world.h"

#include <algorithm>

namespace viewer {

using namespace demo;

namespace {

constexpr double floor_height = -1.05; /* a little below the flake */

StageSetup setup_of(const Options &options) {
    StageSetup setup;
    setup.grid.kind = options.grid;
    setup.grid.resolution = options.resolution;
    setup.workers = options.workers;
    return setup;
}

Form make_box(Stage &stage, double half) {
    const double lo[3] = {-half, -half, -half}, hi[3] = {half, half, half};
    return stage.box(lo, hi);
}

} // namespace

World::World(const Options &options, const Notes &notes)
    : stage_(setup_of(options)), ball_(stage_.sphere(handful)), box_(make_box(stage_, handful)) {
    std::optional<double> floor = floor_height;
    if (!options.gltf.empty()) {
        try {
            auto engine = std::make_unique<Engine>(stage_, options.gltf, options.seed, notes);
            floor = engine->floor() - 0.01; /* the model would else lie in its surface */
            act_ = std::move(engine);
        } catch (const std::exception &error) {
            throw std::runtime_error(options.gltf + ": " + error.what());
        }
        smooth_ = true;
    } else if (options.spheres > 0) {
        act_ = std::make_unique<Field>(stage_, looks_, options.spheres, options.moving, options.seed);
        floor.reset(); /* nothing but balls: traces leave out what only boxes need */
    } else {
        act_ = std::make_unique<Flake>(stage_, options.flake, floor_height, options.seed);
    }
    act_->advance(options.time, looks_);
    if (floor) ground_ = insert_ground(stage_, looks_, *floor);
}

void World::advance(double time) {
    act_->advance(time, looks_);
}

bool World::take(rg_object object) {
    if (object == ground_) return false;
    act_->release(object);
    return true;
}

void World::move(rg_object object, const Imath::V3d &position) {
    Body body;
    body.object = object;
    std::copy_n(&position.x, 3, body.pose.position);
    stage_.move(&body, 1, false);
}

void World::remove(rg_object object) {
    Body body;
    body.object = object;
    stage_.remove(&body, 1);
}

rg_object World::insert(const Form &form, const Imath::V3d &position) {
    Body body;
    body.form = form;
    body.pose = rg_pose_at(position.x, position.y, position.z);
    stage_.insert(&body, 1);
    looks_.set(body.object, look_by_id(body.object));
    return body.object;
}

rg_object World::insert_ball(const Imath::V3d &position) {
    return insert(ball_, position);
}

rg_object World::insert_box(const Imath::V3d &position) {
    return insert(box_, position);
}

void World::configure(rg_grid_kind kind, uint32_t resolution) {
    rg_grid_config config;
    check(rg_grid_config_default(&config, sizeof config));
    config.kind = kind;
    config.resolution = resolution;
    check(rg_grid_configure(stage_.scene(), RG_GRID_OF_SCENE, &config));
}

rg_grid_report World::grid() const {
    rg_grid_report report = {};
    report.size = sizeof report;
    check(rg_grid_stats(stage_.scene(), RG_GRID_OF_SCENE, &report));
    return report;
}

} // namespace viewer
