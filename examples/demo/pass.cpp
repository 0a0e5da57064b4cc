/* SPDX-License-Identifier: MIT */
#include "pass.h"

#include "clock.h"

namespace demo {

namespace {

/* A number in [0, 1) that looks random but differs as much as can be between neighbours (Jimenez 2014). */
float gradient_noise(size_t x, size_t y) {
    const double inner = 0.06711056 * double(x) + 0.00583715 * double(y);
    const double value = 52.9829189 * (inner - std::floor(inner));
    return float(value - std::floor(value));
}

/* A direction around `normal`, as often as its cosine says, so that all count the same. */
Imath::V3f cosine_direction(const Imath::V3f &normal, float a, float b) {
    /* A point of the unit sphere around the tip of the normal. */
    const float z = 1 - 2 * a, r = std::sqrt(std::fmax(0.0f, 1 - z * z)), angle = float(2 * M_PI) * b;
    const Imath::V3f direction = normal * 1.001f + Imath::V3f(r * std::cos(angle), r * std::sin(angle), z);
    return direction.normalized();
}

float fraction(double x) {
    return float(x - std::floor(x));
}

rg_output3 view(std::vector<Imath::V3f> &array) {
    return rg_output3_packed(array.data(), sizeof(Imath::V3f), RG_F32);
}
rg_input3 view(const std::vector<Imath::V3d> &array) {
    return rg_input3_packed(array.data(), sizeof(Imath::V3d), RG_F64);
}

} // namespace

Pass::Pass(uint32_t width, uint32_t height) : width_(width), height_(height) {
    const size_t count = size_t(width) * height;
    directions.resize(count), t.resize(count), objects.resize(count), primitives.resize(count);
    normals.resize(count), u.resize(count), v.resize(count), offsets.resize(count), positions.resize(count);
}

void Pass::trace(rg_scene *scene, const Camera &camera, double x, double y, uint32_t number, Cost &cost) {
    eye = camera.eye;
    for (uint32_t row = 0, pixel = 0; row < height_; ++row)
        for (uint32_t column = 0; column < width_; ++column, ++pixel)
            directions[pixel] = camera.direction(column + x, row + y);
    trace_primary(scene, cost);
    trace_sun(scene, cost);
    trace_sky(scene, number, cost);
}

void Pass::trace_primary(rg_scene *scene, Cost &cost) {
    rg_ray_views rays = {};
    rays.size = sizeof rays;
    rays.origin = rg_input3_packed(&eye, 0, RG_F64); /* stride 0: the same for all */
    rays.direction = rg_input3_packed(directions.data(), sizeof(Imath::V3f), RG_F32);
    rg_hit_views hits = {};
    hits.size = sizeof hits;
    hits.t = {t.data(), sizeof(double), RG_F64};
    hits.object = {objects.data(), sizeof(rg_object), RG_U64};
    hits.primitive = {primitives.data(), sizeof(uint32_t), RG_U32};
    hits.normal = view(normals);
    hits.u = {u.data(), sizeof(float), RG_F32};
    hits.v = {v.data(), sizeof(float), RG_F32};
    hits.position = rg_output3_packed(positions.data(), sizeof(Imath::V3d), RG_F64);
    hits.offset = {offsets.data(), sizeof(float), RG_F32};
    const Stopwatch watch;
    check(rg_scene_trace_views(scene, nullptr, &rays, &hits, pixels()));
    cost.primary += watch.seconds();
    cost.primary_rays += pixels();
}

/* The geometric normal on the side that is seen. */
Imath::V3f Pass::facing(size_t pixel) const {
    return normals[pixel].dot(directions[pixel]) > 0 ? -normals[pixel] : normals[pixel];
}

/* Where rays that leave on the seen side start, so that they don't meet the same spot again. */
Imath::V3d Pass::lifted(size_t pixel) const {
    return positions[pixel] + Imath::V3d(facing(pixel)) * offsets[pixel];
}

void Pass::trace_sun(rg_scene *scene, Cost &cost) {
    sunlit.assign(pixels(), 0);
    sun_pixels.clear(), sun_origins.clear();
    for (size_t pixel = 0; pixel < pixels(); ++pixel) {
        if (!hit(pixel)) continue;
        if (facing(pixel).dot(sun_direction) <= 0) continue;
        sun_pixels.push_back(uint32_t(pixel));
        sun_origins.push_back(lifted(pixel));
    }
    sun_hidden.resize(sun_pixels.size());
    rg_ray_views rays = {};
    rays.size = sizeof rays;
    rays.origin = view(sun_origins);
    rays.direction = rg_input3_packed(&sun_direction, 0, RG_F32);
    const rg_output hidden = {sun_hidden.data(), 1, RG_U8};
    const Stopwatch watch;
    if (!sun_pixels.empty()) check(rg_scene_occluded_views(scene, nullptr, &rays, &hidden, sun_pixels.size()));
    cost.shadow += watch.seconds();
    cost.shadow_rays += sun_pixels.size();
    for (size_t i = 0; i < sun_pixels.size(); ++i) sunlit[sun_pixels[i]] = !sun_hidden[i];
}

void Pass::trace_sky(rg_scene *scene, uint32_t number, Cost &cost) {
    open.assign(pixels(), 0);
    sky_pixels_.clear(), sky_origins_.clear(), sky_directions_.clear();
    for (size_t pixel = 0; pixel < pixels(); ++pixel) {
        if (!hit(pixel)) continue;
        const float noise = gradient_noise(pixel % width_, pixel / width_);
        const float other = gradient_noise(pixel % width_ + 47, pixel / width_ + 17);
        sky_pixels_.push_back(uint32_t(pixel));
        sky_origins_.push_back(lifted(pixel));
        sky_directions_.push_back(cosine_direction(facing(pixel), fraction(noise + number * 0.7548776662),
                                                   fraction(other + number * 0.5698402910)));
    }
    sky_hidden_.resize(sky_pixels_.size());
    rg_ray_views rays = {};
    rays.size = sizeof rays;
    rays.origin = view(sky_origins_);
    rays.direction = rg_input3_packed(sky_directions_.data(), sizeof(Imath::V3f), RG_F32);
    rays.t_max = {&ambient_reach, 0, RG_F32};
    const rg_output hidden = {sky_hidden_.data(), 1, RG_U8};
    const Stopwatch watch;
    if (!sky_pixels_.empty()) check(rg_scene_occluded_views(scene, nullptr, &rays, &hidden, sky_pixels_.size()));
    cost.shadow += watch.seconds();
    cost.shadow_rays += sky_pixels_.size();
    for (size_t i = 0; i < sky_pixels_.size(); ++i) open[sky_pixels_[i]] = !sky_hidden_[i];
}

rg_ray Pass::primary_ray(size_t pixel) const {
    const Imath::V3d direction(directions[pixel]);
    return rg_ray_from(&eye.x, &direction.x);
}

rg_hit Pass::primary_hit(size_t pixel) const {
    rg_hit hit = {};
    hit.t = t[pixel];
    hit.object = objects[pixel];
    hit.primitive = primitives[pixel];
    hit.u = u[pixel];
    hit.v = v[pixel];
    hit.offset = offsets[pixel];
    for (int axis = 0; axis < 3; ++axis) {
        hit.position[axis] = positions[pixel][axis];
        hit.normal[axis] = normals[pixel][axis];
    }
    return hit;
}

rg_ray Pass::sun_ray(size_t index) const {
    const Imath::V3d direction(sun_direction);
    return rg_ray_from(&sun_origins[index].x, &direction.x);
}

} // namespace demo
