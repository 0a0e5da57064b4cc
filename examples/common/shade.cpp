/* SPDX-License-Identifier: MIT */
#include "shade.h"

#include <algorithm>

namespace demo {

namespace {

const Imath::V3f sun_light(2.9f, 2.5f, 1.95f);
const Imath::V3f sky_zenith(0.06f, 0.18f, 0.46f), sky_horizon(0.58f, 0.68f, 0.80f), ground_light(0.16f, 0.16f, 0.17f);

Imath::V3f mix(const Imath::V3f &a, const Imath::V3f &b, float share) {
    return a + (b - a) * share;
}

float clamp01(float x) {
    return std::min(std::max(x, 0.0f), 1.0f);
}

Imath::V3f sky(const Imath::V3f &direction) {
    return mix(sky_horizon, sky_zenith, std::pow(clamp01(direction.y), 0.55f));
}

/* Light of the whole half space around a normal, when nothing hides it. */
Imath::V3f ambient(const Imath::V3f &normal) {
    return mix(ground_light, mix(sky_zenith, sky_horizon, 0.55f), 0.5f + 0.5f * normal.y) * 0.85f;
}

/* Where a file has normals, they are blended by the weights of the corners, as the modeller meant it. */
Imath::V3f smooth_normal(const Look &look, const Pass &pass, size_t pixel, const Imath::V3f &geometric) {
    if (!look.surface) return geometric;
    const uint32_t *corner = &look.surface->corners[size_t(3) * pass.primitives[pixel]];
    const std::vector<Imath::V3f> &normals = look.surface->normals;
    const float u = pass.u[pixel], v = pass.v[pixel];
    const Imath::V3f blend = normals[corner[0]] * (1 - u - v) + normals[corner[1]] * u + normals[corner[2]] * v;
    const Imath::V3f world = (blend * look.normals).normalized();
    if (!(world.dot(world) > 0.5f)) return geometric; /* they cancel out */
    return world.dot(geometric) < 0 ? -world : world;
}

/* Thin lines a unit apart, fading out before they would flicker, so that one sees the ground's extent. */
Imath::V3f ground_colour(const Look &look, const Imath::V3d &position, double distance) {
    const auto line = [](double x) { return std::fabs(x - std::round(x)) < 0.012; };
    const float fade = float(0.35 / (1 + distance * distance / 90));
    return look.colour * (line(position.x) || line(position.z) ? 1 - fade : 1.0f);
}

/* Schlick's Fresnel term times a highlight and the mirrored sky: a coat of varnish. */
Imath::V3f varnish(float gloss, const Imath::V3f &normal, const Imath::V3f &view, bool sunlit, float open) {
    const Imath::V3f mirrored = view - normal * (2 * view.dot(normal));
    const float graze = 1 - clamp01(-view.dot(normal)), graze2 = graze * graze;
    const float fresnel = 0.04f + 0.96f * graze2 * graze2 * graze;
    const float toward_sun = clamp01(mirrored.dot(sun_direction));
    const float power = 12 + 180 * gloss * gloss;
    Imath::V3f light(0);
    if (sunlit && toward_sun > 0.3f) light += sun_light * (std::pow(toward_sun, power) * (power + 2) * 0.02f);
    const Imath::V3f seen = mirrored.y > 0 ? sky(mirrored) : ground_light;
    light += seen * (0.25f + 0.75f * open);
    return light * (fresnel * gloss);
}

} // namespace

Imath::V3f shade(const Looks &looks, const Pass &pass, size_t pixel) {
    const Imath::V3f &view = pass.directions[pixel];
    if (!pass.hit(pixel)) return sky(view);
    const Look &look = looks.of(pass.objects[pixel]);
    const Imath::V3f raw = pass.normals[pixel], geometric = raw.dot(view) > 0 ? -raw : raw;
    const Imath::V3f normal = smooth_normal(look, pass, pixel, geometric);
    const float distance = float(pass.t[pixel]); /* directions have length 1 */
    const bool ground = look.kind == Look::Kind::Ground;
    const Imath::V3f colour = ground ? ground_colour(look, pass.positions[pixel], distance) : look.colour;

    const bool sunlit = pass.sunlit[pixel];
    const float open = pass.open[pixel];
    Imath::V3f light = ambient(normal) * (0.3f + 0.7f * open);
    if (sunlit) light += sun_light * clamp01(normal.dot(sun_direction)) * 0.75f;
    Imath::V3f seen = colour * light;
    if (look.gloss > 0) seen += varnish(look.gloss, normal, view, sunlit, open);

    const float haze = ground ? 1 - std::exp(-distance * distance / 700) : 1 - std::exp(-distance / 160);
    return mix(seen, sky_horizon, haze);
}

} // namespace demo
