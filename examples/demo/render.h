/* SPDX-License-Identifier: MIT */
/* render.h: a world and a camera to a picture. */
#ifndef DEMO_RENDER_H
#define DEMO_RENDER_H

#include "picture.h"
#include "shade.h"

namespace demo {

class Renderer {
  public:
    explicit Renderer(const Options &options);

    /** Renders the world as it is; `phase` from 0 to 1 says where on its path the camera is. */
    Pass::Cost render(World &world, double phase);

    const Picture &picture() const { return picture_; }

    /** The last pass of the last frame: the rays through the centres of the pixels. */
    const Pass &pass() const { return pass_; }

  private:
    void develop(const World &world, const Imath::V3d &forward, bool centre);

    uint32_t samples_;
    Pass pass_;
    Picture picture_;
};

} // namespace demo

#endif
