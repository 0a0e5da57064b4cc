/* SPDX-License-Identifier: MIT */
#include "render.h"

namespace demo {

Renderer::Renderer(uint32_t width, uint32_t height, Crew &crew) : crew_(crew), pass_(width, height, crew) {
    picture_.width = width;
    picture_.height = height;
    picture_.colour.resize(pass_.pixels());
    picture_.depth.resize(pass_.pixels());
    picture_.id.resize(pass_.pixels());
}

void Renderer::add(rg_scene *scene, const Looks &looks, const Camera &camera, uint32_t number, const PassWants &wants,
                   Pass::Cost &cost) {
    /* Roberts' R2 sequence spreads the rays over a pixel. */
    const double x = 0.5 + number * 0.7548776662466927, y = 0.5 + number * 0.5698402909980532;
    pass_.trace(scene, camera, x - std::floor(x), y - std::floor(y), number, wants, cost);
    ++samples_;
    develop(looks, camera.forward, number == 0);
}

void Renderer::develop(const Looks &looks, const Imath::V3d &forward, bool centre) {
    const float share = 1.0f / float(samples_);
    crew_.run(pass_.pixels(), [&](size_t first, size_t end) {
        for (size_t pixel = first; pixel < end; ++pixel) {
            const size_t place = pass_.place(pixel);
            const Imath::V3f seen = shade(looks, pass_, pixel);
            Imath::V3f &mean = picture_.colour[place];
            mean = samples_ == 1 ? seen : mean + (seen - mean) * share;
            if (!centre) continue;
            const double along = Imath::V3d(pass_.directions[pixel]).dot(forward);
            picture_.depth[place] = pass_.hit(pixel) ? float(pass_.t[pixel] * along) : HUGE_VALF;
            picture_.id[place] = pass_.hit(pixel) ? RG_OBJECT_SLOT(pass_.objects[pixel]) + 1 : 0;
        }
    });
}

} // namespace demo
