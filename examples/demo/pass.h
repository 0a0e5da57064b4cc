/* SPDX-License-Identifier: MIT */
/*
 * pass.h: one ray through each pixel, and what comes back: raygrid's outputs in the arrays that the shading reads.
 *
 * Nothing is copied between the two: rays and hits are views of these arrays, and only what shading needs is asked
 * for.
 */
#ifndef DEMO_PASS_H
#define DEMO_PASS_H

#include "camera.h"
#include "handles.h"

#include <vector>

namespace demo {

/** The direction towards the sun, of length 1 but for rounding. */
inline const Imath::V3f sun_direction(0.28f, 0.80f, 0.53066f);

/** How far up the sky is looked for: nearer things darken a place, farther ones don't. */
constexpr float ambient_reach = 0.5f;

class Pass {
  public:
    Pass(uint32_t width, uint32_t height);

    struct Cost {
        double primary = 0, shadow = 0; /* seconds */
        uint64_t primary_rays = 0, shadow_rays = 0;
    };

    /** Traces a ray through each pixel, x, y in [0, 1) from its corner, then the rays to the sun and into the sky. */
    void trace(rg_scene *scene, const Camera &camera, double x, double y, uint32_t number, Cost &cost);

    size_t pixels() const { return directions.size(); }
    bool hit(size_t pixel) const { return objects[pixel] != RG_NO_OBJECT; }

    /* What was asked and answered, in the plain form that the check against brute force takes. */
    rg_ray primary_ray(size_t pixel) const;
    rg_hit primary_hit(size_t pixel) const;
    rg_ray sun_ray(size_t index) const;

    /* Primary rays: one a pixel, row by row. */
    Imath::V3d eye;
    std::vector<Imath::V3f> directions;
    std::vector<double> t;
    std::vector<rg_object> objects;
    std::vector<uint32_t> primitives;
    std::vector<Imath::V3f> normals;
    std::vector<float> u, v, offsets;
    std::vector<Imath::V3d> positions;

    /* Per pixel: 1 if the sun or the sky is seen from there. */
    std::vector<uint8_t> sunlit, open;

    /* Rays to the sun: only from where the surface faces it. */
    std::vector<uint32_t> sun_pixels;
    std::vector<Imath::V3d> sun_origins;
    std::vector<uint8_t> sun_hidden;

  private:
    void trace_primary(rg_scene *scene, Cost &cost);
    void trace_sun(rg_scene *scene, Cost &cost);
    void trace_sky(rg_scene *scene, uint32_t number, Cost &cost);
    Imath::V3d lifted(size_t pixel) const;
    Imath::V3f facing(size_t pixel) const;

    uint32_t width_, height_;
    std::vector<uint32_t> sky_pixels_;
    std::vector<Imath::V3d> sky_origins_;
    std::vector<Imath::V3f> sky_directions_;
    std::vector<uint8_t> sky_hidden_;
};

} // namespace demo

#endif
