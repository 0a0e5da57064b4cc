/* SPDX-License-Identifier: MIT */
#include "render.h"

#include <algorithm>

namespace demo {

namespace {

constexpr float infinity = HUGE_VALF;

} // namespace

Renderer::Renderer(const Options &options) : samples_(options.samples), pass_(options.width, options.height) {
    picture_.width = options.width;
    picture_.height = options.height;
    picture_.colour.resize(pass_.pixels());
    picture_.depth.resize(pass_.pixels());
    picture_.id.resize(pass_.pixels());
}

Pass::Cost Renderer::render(World &world, double phase) {
    const Camera camera(phase, picture_.width, picture_.height);
    std::fill(picture_.colour.begin(), picture_.colour.end(), Imath::V3f(0));
    Pass::Cost cost;
    /* Roberts' R2 sequence spreads the rays over a pixel; its first is the centre, traced last so that it stays. */
    for (uint32_t sample = samples_; sample-- > 0;) {
        const double x = 0.5 + sample * 0.7548776662466927, y = 0.5 + sample * 0.5698402909980532;
        pass_.trace(world.stage().scene(), camera, x - std::floor(x), y - std::floor(y), sample, cost);
        develop(world, camera.forward, sample == 0);
    }
    return cost;
}

void Renderer::develop(const World &world, const Imath::V3d &forward, bool centre) {
    for (size_t pixel = 0; pixel < pass_.pixels(); ++pixel) {
        picture_.colour[pixel] += shade(world, pass_, pixel) / float(samples_);
        if (!centre) continue;
        const double along = Imath::V3d(pass_.directions[pixel]).dot(forward);
        picture_.depth[pixel] = pass_.hit(pixel) ? float(pass_.t[pixel] * along) : infinity;
        picture_.id[pixel] = pass_.hit(pixel) ? RG_OBJECT_SLOT(pass_.objects[pixel]) + 1 : 0;
    }
}

} // namespace demo
