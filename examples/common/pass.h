/* SPDX-License-Identifier: MIT */
/*
 * pass.h: one ray through each pixel, and what comes back: raygrid's outputs in the arrays that the shading reads.
 *
 * Nothing is copied between the two: rays and hits are views of these arrays, and only what shading needs is asked
 * for. Pixels are in the order of small tiles, so that rays that follow one another go nearly the same way.
 */
#ifndef DEMO_PASS_H
#define DEMO_PASS_H

#include "camera.h"
#include "crew.h"
#include "handles.h"

#include <vector>

namespace demo {

/** The direction towards the sun, of length 1 but for rounding. */
inline const Imath::V3f sun_direction(0.28f, 0.80f, 0.53066f);

/** How far up the sky is looked for: nearer things darken a place, farther ones don't. */
constexpr float ambient_reach = 0.5f;

/** What a pass is to find out beside hits and the sun. */
struct PassWants {
    bool sky = true; /* whether the sky is seen in a random direction; else a usual share of it is taken as seen */
    bool corners = true; /* primitive, u and v, for normals that are blended over a triangle */
    bool effort = false; /* into how many cells each primary ray looked */
};

/** Rays that look for anything in their way, from some of the pixels. */
struct ShadowRays {
    size_t count = 0;
    /* The first `count` of each are in use. */
    std::vector<uint32_t> pixels;
    std::vector<Imath::V3d> origins;
    std::vector<uint8_t> hidden;

    void resize(size_t most) { pixels.resize(most), origins.resize(most), hidden.resize(most); }
};

class Pass {
  public:
    Pass(uint32_t width, uint32_t height, Crew &crew);

    struct Cost {
        double primary = 0, shadow = 0; /* seconds */
        uint64_t primary_rays = 0, shadow_rays = 0;
    };

    /**
     * Traces a ray through each pixel, x, y in [0, 1) from its corner, then the rays to the sun and, if wanted, into
     * the sky in directions that differ from one `number` to the next.
     */
    void trace(rg_scene *scene, const Camera &camera, double x, double y, uint32_t number, const PassWants &wants,
               Cost &cost);

    size_t pixels() const { return directions.size(); }
    bool hit(size_t pixel) const { return objects[pixel] != RG_NO_OBJECT; }

    /** Where in the picture a pixel of the arrays below is: counted row by row. */
    uint32_t place(size_t pixel) const { return places_[pixel]; }

    /* What was asked and answered, in the plain form that the check against brute force takes. Rays to the sun go on
       for ever there: that they end is to save time alone. */
    rg_ray primary_ray(size_t pixel) const;
    rg_hit primary_hit(size_t pixel) const;
    rg_ray sun_ray(size_t index) const;

    /* Primary rays: one a pixel. */
    Imath::V3d eye;
    std::vector<Imath::V3f> directions;
    std::vector<double> t;
    std::vector<rg_object> objects;
    std::vector<uint32_t> primitives;
    std::vector<Imath::V3f> normals;
    std::vector<float> u, v, offsets;
    std::vector<Imath::V3d> positions;
    std::vector<uint32_t> cells; /* that the ray looked into, of the last pass that was asked for it */

    /* Per pixel: whether the sun is seen from there, and how much of the sky. */
    std::vector<uint8_t> sunlit;
    std::vector<float> open;

    /* Only from where the surface faces it. */
    ShadowRays sun;

  private:
    void trace_primary(rg_scene *scene, const PassWants &wants, Cost &cost);
    void trace_sun(rg_scene *scene, Cost &cost);
    void trace_sky(rg_scene *scene, uint32_t number, Cost &cost);
    void end_above_all(rg_scene *scene);
    void aim_at_sky(uint32_t number);
    template <typename Wanted> void gather(ShadowRays &rays, Wanted wanted);
    Imath::V3f facing(size_t pixel) const;

    uint32_t width_;
    Crew &crew_;
    std::vector<uint32_t> places_;
    ShadowRays sky_;
    std::vector<Imath::V3f> sky_directions_;
    std::vector<float> sun_ends_; /* t_max of the rays to the sun */
};

} // namespace demo

#endif
