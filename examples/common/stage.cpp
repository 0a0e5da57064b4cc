/* SPDX-License-Identifier: MIT */
#include "stage.h"

#include "clock.h"

#include <algorithm>

namespace demo {

namespace {

rg_pose_views view_poses(const Body *bodies, bool turned) {
    rg_pose_views views;
    check(rg_pose_views_of(&views, sizeof views, &bodies->pose, sizeof(Body)));
    if (!turned) std::fill_n(views.column, 3, rg_input3{}), views.scale = rg_input{};
    return views;
}

rg_input view_objects(const Body *bodies) {
    return {&bodies->object, sizeof(Body), RG_U64};
}

} // namespace

Stage::Stage(const StageSetup &setup) {
    rg_scene_config config;
    check(rg_scene_config_default(&config, sizeof config));
    config.workers = setup.workers;
    config.grid = &setup.grid;
    rg_scene *scene = nullptr;
    check(rg_scene_create(&config, &scene));
    scene_.reset(scene);
    if (setup.twin) twin_.reset(reference_create());
}

Form Stage::own(rg_shape *shape, const reference_shape *twin) {
    shapes_.emplace_back(shape);
    return {shape, twin};
}

Form Stage::sphere(double radius) {
    rg_shape *shape = nullptr;
    check(rg_shape_create_sphere(nullptr, radius, &shape));
    return own(shape, twin_ ? reference_sphere(twin_.get(), radius) : nullptr);
}

Form Stage::box(const double lo[3], const double hi[3]) {
    rg_shape *shape = nullptr;
    check(rg_shape_create_box(nullptr, lo, hi, &shape));
    return own(shape, twin_ ? reference_box(twin_.get(), lo, hi) : nullptr);
}

Form Stage::mesh(const std::vector<double> &vertices, const std::vector<uint32_t> &corners) {
    rg_mesh_views views = {};
    views.size = sizeof views;
    views.vertices = rg_input3_packed(vertices.data(), 3 * sizeof(double), RG_F64);
    views.vertex_count = vertices.size() / 3;
    views.indices = rg_input3_packed(corners.data(), 3 * sizeof(uint32_t), RG_U32);
    views.triangle_count = corners.size() / 3;
    rg_shape *shape = nullptr;
    check(rg_shape_create_mesh(nullptr, &views, &shape));
    return own(shape, twin_ ? reference_mesh(twin_.get(), vertices.data(), vertices.size() / 3, corners.data(),
                                             corners.size() / 3)
                            : nullptr);
}

void Stage::insert(Body *bodies, size_t count) {
    if (count == 0) return;
    rg_insert_views views = {};
    views.size = sizeof views;
    views.shapes = &bodies->form.shape;
    views.shapes_stride = sizeof(Body);
    const rg_pose_views poses = view_poses(bodies, true);
    views.poses = &poses;
    const rg_output objects = {&bodies->object, sizeof(Body), RG_U64};
    const Stopwatch watch;
    check(rg_scene_insert_many(scene_.get(), &views, count, &objects));
    seconds_ += watch.seconds();
    for (size_t i = 0; twin_ && i < count; ++i)
        reference_insert(twin_.get(), bodies[i].object, bodies[i].form.twin, &bodies[i].pose, UINT32_MAX);
}

void Stage::move(const Body *bodies, size_t count, bool turned) {
    if (count == 0) return;
    const rg_input objects = view_objects(bodies);
    const rg_pose_views poses = view_poses(bodies, turned);
    const Stopwatch watch;
    check(rg_scene_move_many(scene_.get(), &objects, &poses, count));
    seconds_ += watch.seconds();
    for (size_t i = 0; twin_ && i < count; ++i) reference_move(twin_.get(), bodies[i].object, &bodies[i].pose);
}

void Stage::remove(const Body *bodies, size_t count) {
    if (count == 0) return;
    const rg_input objects = view_objects(bodies);
    const Stopwatch watch;
    check(rg_scene_remove_many(scene_.get(), &objects, count));
    seconds_ += watch.seconds();
    for (size_t i = 0; twin_ && i < count; ++i) reference_remove(twin_.get(), bodies[i].object);
}

double Stage::take_seconds() {
    const double seconds = seconds_;
    seconds_ = 0;
    return seconds;
}

} // namespace demo
