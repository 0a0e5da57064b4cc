/* SPDX-License-Identifier: MIT */
/* picture.h: a rendered frame, and how it is written. */
#ifndef DEMO_PICTURE_H
#define DEMO_PICTURE_H

#include <Imath/ImathVec.h>
#include <cstdint>
#include <string>
#include <vector>

namespace demo {

/** Pixels row by row from the upper left. */
struct Picture {
    uint32_t width, height;
    std::vector<Imath::V3f> colour; /* linear light of the sRGB primaries */
    std::vector<float> depth; /* along the camera's axis to what the pixel's centre sees; infinite for nothing */
    std::vector<uint32_t> id; /* slot of the object there, plus 1; 0 for nothing */
};

/** Writes OpenEXR: scanlines, ZIP, channels B, G, R in half, Z in float and id in uint. Throws std::runtime_error. */
void write_exr(const std::string &path, const Picture &picture);

/** Writes an 8-bit sRGB PNG, the light compressed to what a screen shows. Throws std::runtime_error. */
void write_png(const std::string &path, const Picture &picture);

/** Writes pixels as a screen has them, 8-bit sRGB: R, G, B, row by row. Throws std::runtime_error. */
void write_png(const std::string &path, uint32_t width, uint32_t height, const std::vector<uint8_t> &pixels);

/** Many small pictures in one, side by side as they were added. */
class ContactSheet {
  public:
    /** For `count` pictures of one size. */
    explicit ContactSheet(size_t count);

    /** Adds the picture as a screen shows it; if it is larger than a tile, shrunk to one by averaging light. */
    void add(const Picture &picture);

    void write(const std::string &path) const;

  private:
    static constexpr uint32_t tile = 256, gap = 4, most_columns = 6;

    void start(const Picture &first);

    size_t count_, added_ = 0;
    uint32_t tile_width_ = 0, tile_height_ = 0, width_ = 0, height_ = 0;
    std::vector<uint16_t> pixels_; /* of the whole sheet: R, G, B, linear */
};

} // namespace demo

#endif
