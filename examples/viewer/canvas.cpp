/* SPDX-License-Identifier: MIT */
#include "canvas.h"

#include "tone.h"

#include <array>

namespace viewer {

using namespace demo;
using Imath::V3d;

namespace {

constexpr size_t steps = 4096;   /* of light that are told apart: darker ones are less than one step of a screen */
constexpr double nearest = 0.01; /* depth at which edges are cut off */

/* IEC 61966-2-1. */
double encode(double light) {
    return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

std::array<uint8_t, steps + 1> make_table() {
    std::array<uint8_t, steps + 1> table;
    for (size_t i = 0; i <= steps; ++i) table[i] = uint8_t(std::lround(255 * encode(double(i) / steps)));
    return table;
}

uint32_t byte(float x) {
    return uint32_t(std::lround(255 * std::clamp(x, 0.0f, 1.0f)));
}

/* Cuts from + s * way to where it is at least 0; false if nothing is left of [first, last]. */
bool cut(double from, double way, double &first, double &last) {
    if (way == 0) return from >= 0;
    double &end = way > 0 ? first : last;
    end = way > 0 ? std::max(end, -from / way) : std::min(end, -from / way);
    return first < last;
}

} // namespace

void Canvas::show(const Picture &picture, Crew &crew) {
    static const std::array<uint8_t, steps + 1> table = make_table();
    crew.run(pixels_.size(), [&](size_t first, size_t end) {
        for (size_t i = first; i < end; ++i) {
            const Imath::V3f light = tone_map(picture.colour[i]) * float(steps);
            pixels_[i] = uint32_t(table[size_t(light.x + 0.5f)]) << 16 |
                         uint32_t(table[size_t(light.y + 0.5f)]) << 8 | table[size_t(light.z + 0.5f)];
        }
    });
}

void Canvas::cover(size_t pixel, const Colour &colour, float share) {
    const uint32_t old = pixels_[pixel];
    const Colour below(float(old >> 16 & 255) / 255, float(old >> 8 & 255) / 255, float(old & 255) / 255);
    const Colour mixed = below + (colour - below) * share;
    pixels_[pixel] = byte(mixed.x) << 16 | byte(mixed.y) << 8 | byte(mixed.z);
}

/* `from` and `to` are points of the picture with their depths: between them the reciprocal of the depth is linear. */
void Canvas::draw_edge(const V3d &from, const V3d &to, const Picture &picture, const Colour &colour) {
    const double x = to.x - from.x, y = to.y - from.y, step = 1 / std::max({std::fabs(x), std::fabs(y), 1.0});
    double first = 0, last = 1;
    if (!cut(from.x, x, first, last) || !cut(width_ - 1e-3 - from.x, -x, first, last)) return;
    if (!cut(from.y, y, first, last) || !cut(height_ - 1e-3 - from.y, -y, first, last)) return;
    for (double s = first; s < last; s += step) {
        const double depth = 1 / (1 / from.z + (1 / to.z - 1 / from.z) * s);
        const int64_t column = int64_t(from.x + x * s), row = int64_t(from.y + y * s);
        if (column < 0 || row < 0 || column >= width_ || row >= height_) continue;
        const size_t pixel = size_t(row) * width_ + size_t(column);
        cover(pixel, colour, depth * 0.999 <= picture.depth[pixel] ? 1.0f : 0.35f);
    }
}

void Canvas::draw_box(const double lo[3], const double hi[3], const Camera &camera, const Picture &picture,
                      const Colour &colour) {
    const auto corner = [&](int i) {
        return V3d(i & 1 ? hi[0] : lo[0], i & 2 ? hi[1] : lo[1], i & 4 ? hi[2] : lo[2]);
    };
    for (int i = 0; i < 8; ++i)
        for (int axis = 1; axis < 8; axis *= 2) {
            if (i & axis) continue;
            const V3d from = corner(i), way = corner(i | axis) - from;
            double first = 0, last = 1; /* what lies before the camera */
            if (!cut((from - camera.eye).dot(camera.forward) - nearest, way.dot(camera.forward), first, last))
                continue;
            draw_edge(camera.project(from + way * first), camera.project(from + way * last), picture, colour);
        }
}

void Canvas::write(const std::string &path) const {
    std::vector<uint8_t> bytes;
    bytes.reserve(3 * pixels_.size());
    for (const uint32_t pixel : pixels_)
        for (int shift : {16, 8, 0}) bytes.push_back(uint8_t(pixel >> shift));
    write_png(path, width_, height_, bytes);
}

} // namespace viewer
