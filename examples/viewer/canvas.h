/* SPDX-License-Identifier: MIT */
/* canvas.h: the pixels of the window, and what is drawn on them. */
#ifndef VIEWER_CANVAS_H
#define VIEWER_CANVAS_H

#include "camera.h"
#include "crew.h"
#include "picture.h"

namespace viewer {

/** A colour as screens have it: sRGB, each from 0 to 1. */
using Colour = Imath::V3f;

class Canvas {
  public:
    Canvas(uint32_t width, uint32_t height) : width_(width), height_(height), pixels_(size_t(width) * height) {}

    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }

    /** Row by row from the upper left, 0x00RRGGBB. */
    uint32_t *pixels() { return pixels_.data(); }
    const uint32_t *pixels() const { return pixels_.data(); }

    /** Covers all with a picture of the same size, as a screen shows its light. */
    void show(const demo::Picture &picture, demo::Crew &crew);

    /** Lets a share of a colour cover a pixel, counted row by row. */
    void cover(size_t pixel, const Colour &colour, float share);

    /** The edges of a box in space; faint where the picture has something before them. */
    void draw_box(const double lo[3], const double hi[3], const demo::Camera &camera, const demo::Picture &picture,
                  const Colour &colour);

    /** As PNG. Throws std::runtime_error. */
    void write(const std::string &path) const;

  private:
    void draw_edge(const Imath::V3d &from, const Imath::V3d &to, const demo::Picture &picture, const Colour &colour);

    uint32_t width_, height_;
    std::vector<uint32_t> pixels_;
};

} // namespace viewer

#endif
