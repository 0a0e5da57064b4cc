/* SPDX-License-Identifier: MIT */
#include "picture.h"

#include "tone.h"

#include <cmath>
#include <png.h>
#include <stdexcept>

namespace demo {

namespace {

/*
 * Shrinks by the mean over each new pixel's footprint, edges by their share: along rows, then again along columns of
 * the transposed result. `count` rows of `from` pixels become `count` rows of `to`, stored transposed.
 */
std::vector<Imath::V3f> shrink(const std::vector<Imath::V3f> &pixels, uint32_t from, uint32_t count, uint32_t to) {
    std::vector<Imath::V3f> shrunk(size_t(to) * count);
    const double step = double(from) / to;
    for (uint32_t x = 0; x < to; ++x) {
        const double lo = x * step, hi = std::min((x + 1) * step, double(from));
        for (uint32_t y = 0; y < count; ++y) {
            Imath::V3d sum(0);
            for (uint32_t i = uint32_t(lo); i < hi; ++i) {
                const double share = std::min(hi, i + 1.0) - std::max(lo, double(i));
                sum += Imath::V3d(pixels[size_t(y) * from + i]) * share;
            }
            shrunk[size_t(x) * count + y] = Imath::V3f(sum / (hi - lo));
        }
    }
    return shrunk;
}

std::vector<Imath::V3f> tone_mapped(const Picture &picture) {
    std::vector<Imath::V3f> shown;
    shown.reserve(picture.colour.size());
    for (const Imath::V3f &colour : picture.colour) shown.push_back(tone_map(colour));
    return shown;
}

void quantize(const Imath::V3f &colour, uint16_t *to) {
    for (int c = 0; c < 3; ++c) to[c] = uint16_t(std::lround(colour[c] * 65535.0f));
}

void write_image(const std::string &path, uint32_t width, uint32_t height, png_uint_32 format, const void *pixels) {
    png_image image = {};
    image.version = PNG_IMAGE_VERSION;
    image.width = width;
    image.height = height;
    image.format = format;
    if (!png_image_write_to_file(&image, path.c_str(), 1, pixels, 0, nullptr))
        throw std::runtime_error("can't write '" + path + "': " + image.message);
}

/* libpng itself encodes 16-bit linear light to 8-bit sRGB. */
void write_linear(const std::string &path, uint32_t width, uint32_t height, const std::vector<uint16_t> &pixels) {
    write_image(path, width, height, PNG_FORMAT_LINEAR_RGB, pixels.data());
}

} // namespace

void write_png(const std::string &path, const Picture &picture) {
    std::vector<uint16_t> pixels(picture.colour.size() * 3);
    for (size_t i = 0; i < picture.colour.size(); ++i) quantize(tone_map(picture.colour[i]), &pixels[3 * i]);
    write_linear(path, picture.width, picture.height, pixels);
}

void write_png(const std::string &path, uint32_t width, uint32_t height, const std::vector<uint8_t> &pixels) {
    write_image(path, width, height, PNG_FORMAT_RGB, pixels.data());
}

ContactSheet::ContactSheet(size_t count) : count_(count) {}

void ContactSheet::start(const Picture &first) {
    const double factor = std::min(1.0, double(tile) / std::max(first.width, first.height));
    tile_width_ = std::max(1u, uint32_t(std::lround(first.width * factor)));
    tile_height_ = std::max(1u, uint32_t(std::lround(first.height * factor)));
    const uint32_t columns = uint32_t(std::min<size_t>(count_, most_columns));
    const uint32_t rows = uint32_t((count_ + columns - 1) / columns);
    width_ = columns * (tile_width_ + gap) + gap;
    height_ = rows * (tile_height_ + gap) + gap;
    pixels_.assign(size_t(3) * width_ * height_, UINT16_MAX);
}

void ContactSheet::add(const Picture &picture) {
    if (added_ == 0) start(picture);
    const std::vector<Imath::V3f> narrow = shrink(tone_mapped(picture), picture.width, picture.height, tile_width_);
    const std::vector<Imath::V3f> small = shrink(narrow, picture.height, tile_width_, tile_height_);
    const size_t left = gap + added_ % most_columns * (tile_width_ + gap);
    const size_t top = gap + added_ / most_columns * (tile_height_ + gap);
    for (size_t y = 0; y < tile_height_; ++y)
        for (size_t x = 0; x < tile_width_; ++x)
            quantize(small[y * tile_width_ + x], &pixels_[3 * ((top + y) * width_ + left + x)]);
    ++added_;
}

void ContactSheet::write(const std::string &path) const {
    write_linear(path, width_, height_, pixels_);
}

} // namespace demo
