/* SPDX-License-Identifier: MIT */
#include "hand.h"

namespace viewer {

using namespace demo;
using Imath::V3d;

rg_hit look_at(rg_scene *scene, const Camera &camera, double x, double y) {
    const V3d direction(camera.direction(x, y));
    const rg_ray ray = rg_ray_from(&camera.eye.x, &direction.x);
    rg_hit hit = {};
    check(rg_scene_trace(scene, &ray, &hit, 1));
    return hit;
}

void Hand::grab(World &world, const Camera &camera, double x, double y) {
    const rg_hit hit = look_at(world.scene(), camera, x, y);
    if (hit.object == RG_NO_OBJECT || !world.take(hit.object)) return;
    rg_object_report report = {};
    report.size = sizeof report;
    check(rg_scene_lookup(world.scene(), hit.object, &report));
    const double *at = report.pose.position, *spot = hit.position;
    held_ = hit.object;
    position_ = V3d(at[0], at[1], at[2]);
    depth_ = camera.project(V3d(spot[0], spot[1], spot[2])).z;
    from_spot_ = position_ - camera.place(x, y, depth_);
}

bool Hand::drag(World &world, const Camera &camera, double x, double y) {
    if (held_ == RG_NO_OBJECT) return false;
    const V3d position = camera.place(x, y, depth_) + from_spot_;
    if (position == position_) return false;
    world.move(held_, position);
    position_ = position;
    return true;
}

void Hand::push(double steps) {
    depth_ *= std::pow(1.05, steps);
}

} // namespace viewer
