/* SPDX-License-Identifier: MIT */
/* render.h: a scene and a camera to a picture that gets better with each sample. */
#ifndef DEMO_RENDER_H
#define DEMO_RENDER_H

#include "picture.h"
#include "shade.h"

namespace demo {

class Renderer {
  public:
    Renderer(uint32_t width, uint32_t height, Crew &crew);

    /** Begins a new picture. */
    void restart() { samples_ = 0; }

    /**
     * Adds a sample a pixel to the picture: its mean is shown. `number` says where in the pixel: each differs, and 0
     * is the centre, from which depth and id are.
     */
    void add(rg_scene *scene, const Looks &looks, const Camera &camera, uint32_t number, const PassWants &wants,
             Pass::Cost &cost);

    uint32_t samples() const { return samples_; }
    const Picture &picture() const { return picture_; }

    /** The last pass. */
    const Pass &pass() const { return pass_; }

  private:
    void develop(const Looks &looks, const Imath::V3d &forward, bool centre);

    Crew &crew_;
    uint32_t samples_ = 0;
    Pass pass_;
    Picture picture_;
};

} // namespace demo

#endif
