/* SPDX-License-Identifier: MIT */
#include "pass.h"

#include "clock.h"

#include <algorithm>

namespace demo {

namespace {

constexpr uint32_t tile = 8; /* pixels along a side */

/* What is taken as seen of the sky where nobody looks: what is seen on average in scenes like the demo's. */
constexpr float usual_openness = 0.75f;

/* The even bits of a number below 64, as a number below 8. */
uint32_t even_bits(uint32_t i) {
    return (i & 1) | (i >> 1 & 2) | (i >> 2 & 4);
}

/* Tiles row by row; in each every aligned run of 4, 16 or 64 pixels is a square (Morton's order). */
std::vector<uint32_t> places_in_tiles(uint32_t width, uint32_t height) {
    std::vector<uint32_t> places;
    places.reserve(size_t(width) * height);
    for (uint32_t top = 0; top < height; top += tile)
        for (uint32_t left = 0; left < width; left += tile)
            for (uint32_t i = 0; i < tile * tile; ++i) {
                const uint32_t x = left + even_bits(i), y = top + even_bits(i >> 1);
                if (x < width && y < height) places.push_back(y * width + x);
            }
    return places;
}

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
rg_output view(std::vector<float> &array) {
    return {array.data(), sizeof(float), RG_F32};
}
rg_output view(std::vector<uint32_t> &array) {
    return {array.data(), sizeof(uint32_t), RG_U32};
}

/* For rays in the order of tiles. */
rg_trace_config coherent() {
    rg_trace_config config;
    check(rg_trace_config_default(&config, sizeof config));
    config.coherence = RG_COHERENCE_HIGH;
    return config;
}

void find_hidden(rg_scene *scene, const rg_trace_config *config, const rg_ray_views &views, ShadowRays &rays,
                 Pass::Cost &cost) {
    const rg_output hidden = {rays.hidden.data(), 1, RG_U8};
    const Stopwatch watch;
    check(rg_scene_occluded_views(scene, config, &views, &hidden, rays.count));
    cost.shadow += watch.seconds();
    cost.shadow_rays += rays.count;
}

} // namespace

Pass::Pass(uint32_t width, uint32_t height, Crew &crew)
    : width_(width), crew_(crew), places_(places_in_tiles(width, height)) {
    const size_t count = places_.size();
    directions.resize(count), t.resize(count), objects.resize(count), primitives.resize(count);
    normals.resize(count), u.resize(count), v.resize(count), offsets.resize(count), positions.resize(count);
    cells.resize(count), sunlit.resize(count), open.resize(count);
    sun.resize(count), sky_.resize(count), sky_directions_.resize(count), sun_ends_.resize(count);
}

void Pass::trace(rg_scene *scene, const Camera &camera, double x, double y, uint32_t number, const PassWants &wants,
                 Cost &cost) {
    eye = camera.eye;
    crew_.run(pixels(), [&](size_t first, size_t end) {
        for (size_t pixel = first; pixel < end; ++pixel)
            directions[pixel] = camera.direction(places_[pixel] % width_ + x, places_[pixel] / width_ + y);
    });
    trace_primary(scene, wants, cost);
    trace_sun(scene, cost);
    if (wants.sky)
        trace_sky(scene, number, cost);
    else
        std::fill(open.begin(), open.end(), usual_openness);
}

void Pass::trace_primary(rg_scene *scene, const PassWants &wants, Cost &cost) {
    rg_ray_views rays = {};
    rays.size = sizeof rays;
    rays.origin = rg_input3_packed(&eye, 0, RG_F64); /* stride 0: the same for all */
    rays.direction = rg_input3_packed(directions.data(), sizeof(Imath::V3f), RG_F32);
    rg_hit_views hits = {};
    hits.size = sizeof hits;
    hits.t = {t.data(), sizeof(double), RG_F64};
    hits.object = {objects.data(), sizeof(rg_object), RG_U64};
    hits.normal = view(normals);
    hits.position = rg_output3_packed(positions.data(), sizeof(Imath::V3d), RG_F64);
    hits.offset = view(offsets);
    if (wants.corners) hits.primitive = view(primitives), hits.u = view(u), hits.v = view(v);
    if (wants.effort) hits.cells = view(cells);
    const rg_trace_config config = coherent();
    const Stopwatch watch;
    check(rg_scene_trace_views(scene, &config, &rays, &hits, pixels()));
    cost.primary += watch.seconds();
    cost.primary_rays += pixels();
}

/* The geometric normal on the side that is seen. */
Imath::V3f Pass::facing(size_t pixel) const {
    return normals[pixel].dot(directions[pixel]) > 0 ? -normals[pixel] : normals[pixel];
}

/* Collects the hits for which wanted() is true, lifted off their surface so that rays don't meet the same spot again.
 */
template <typename Wanted> void Pass::gather(ShadowRays &rays, Wanted wanted) {
    std::vector<size_t> kept((pixels() + Crew::piece - 1) / Crew::piece);
    crew_.run(pixels(), [&](size_t first, size_t end) {
        size_t next = first;
        for (size_t pixel = first; pixel < end; ++pixel) {
            if (!hit(pixel)) continue;
            const Imath::V3f up = facing(pixel);
            if (!wanted(up)) continue;
            rays.pixels[next] = uint32_t(pixel);
            rays.origins[next++] = positions[pixel] + Imath::V3d(up) * offsets[pixel];
        }
        kept[first / Crew::piece] = next - first;
    });
    rays.count = 0;
    for (size_t i = 0; i < kept.size(); ++i) {
        const size_t first = i * Crew::piece;
        std::copy_n(&rays.pixels[first], kept[i], &rays.pixels[rays.count]);
        std::copy_n(&rays.origins[first], kept[i], &rays.origins[rays.count]);
        rays.count += kept[i];
    }
}

/*
 * Rays to the sun end in one plane above all objects (only the ground is infinite): nothing is hit beyond it, and
 * raygrid sees that rays which begin far apart run close together there, so that it can take them along together.
 */
void Pass::end_above_all(rg_scene *scene) {
    rg_grid_report grid = {};
    grid.size = sizeof grid;
    check(rg_grid_stats(scene, RG_GRID_OF_SCENE, &grid));
    const double top = grid.logical_hi[1] + 1e-3 * (grid.logical_hi[1] - grid.logical_lo[1]);
    crew_.run(sun.count, [&](size_t first, size_t end) {
        for (size_t i = first; i < end; ++i)
            sun_ends_[i] = float(std::max(0.0, (top - sun.origins[i].y) / sun_direction.y));
    });
}

void Pass::trace_sun(rg_scene *scene, Cost &cost) {
    gather(sun, [](const Imath::V3f &up) { return up.dot(sun_direction) > 0; });
    end_above_all(scene);
    rg_ray_views rays = {};
    rays.size = sizeof rays;
    rays.origin = view(sun.origins);
    rays.direction = rg_input3_packed(&sun_direction, 0, RG_F32);
    rays.t_max = {sun_ends_.data(), sizeof(float), RG_F32};
    const rg_trace_config config = coherent();
    find_hidden(scene, &config, rays, sun, cost);
    std::fill(sunlit.begin(), sunlit.end(), uint8_t(0));
    for (size_t i = 0; i < sun.count; ++i) sunlit[sun.pixels[i]] = !sun.hidden[i];
}

void Pass::aim_at_sky(uint32_t number) {
    crew_.run(sky_.count, [&](size_t first, size_t end) {
        for (size_t i = first; i < end; ++i) {
            const uint32_t pixel = sky_.pixels[i], x = places_[pixel] % width_, y = places_[pixel] / width_;
            const float noise = gradient_noise(x, y), other = gradient_noise(x + 47, y + 17);
            sky_directions_[i] = cosine_direction(facing(pixel), fraction(noise + number * 0.7548776662),
                                                  fraction(other + number * 0.5698402910));
        }
    });
}

void Pass::trace_sky(rg_scene *scene, uint32_t number, Cost &cost) {
    gather(sky_, [](const Imath::V3f &) { return true; });
    aim_at_sky(number);
    rg_ray_views rays = {};
    rays.size = sizeof rays;
    rays.origin = view(sky_.origins);
    rays.direction = rg_input3_packed(sky_directions_.data(), sizeof(Imath::V3f), RG_F32);
    rays.t_max = {&ambient_reach, 0, RG_F32};
    find_hidden(scene, nullptr, rays, sky_, cost);
    std::fill(open.begin(), open.end(), 0.0f);
    for (size_t i = 0; i < sky_.count; ++i) open[sky_.pixels[i]] = sky_.hidden[i] ? 0.0f : 1.0f;
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
    return rg_ray_from(&sun.origins[index].x, &direction.x);
}

} // namespace demo
