/* SPDX-License-Identifier: MIT */
#include "overlay.h"

#include <algorithm>
#include <cstdio>

namespace viewer {

using namespace demo;
using Imath::V3d;

namespace {

const Colour physical_colour(1.0f, 0.82f, 0.1f), logical_colour(0.2f, 0.9f, 1.0f), held_colour(1, 1, 1);

/* From nothing to the hottest; each is brighter than the one before. */
const Colour heat_colours[] = {{0.02f, 0.02f, 0.10f}, {0.27f, 0.05f, 0.48f}, {0.70f, 0.12f, 0.42f},
                               {0.95f, 0.42f, 0.16f}, {0.99f, 0.78f, 0.22f}, {1.00f, 1.00f, 0.82f}};

/* Neighbouring levels are easy to tell apart. */
const Colour level_colours[] = {{0.90f, 0.25f, 0.20f}, {0.98f, 0.70f, 0.15f}, {0.45f, 0.80f, 0.25f},
                                {0.15f, 0.75f, 0.80f}, {0.25f, 0.45f, 0.95f}, {0.75f, 0.35f, 0.90f},
                                {0.95f, 0.55f, 0.75f}, {0.75f, 0.75f, 0.75f}};

Colour heat_colour(double heat) {
    constexpr int last = sizeof heat_colours / sizeof *heat_colours - 1;
    const double x = std::clamp(heat, 0.0, 1.0) * last;
    const int i = std::min(int(x), last - 1);
    return heat_colours[i] + (heat_colours[i + 1] - heat_colours[i]) * float(x - i);
}

const Colour &level_colour(uint32_t level) {
    return level_colours[level % (sizeof level_colours / sizeof *level_colours)];
}

/* Which cell of a level a place is in, along each axis; cells go on beyond the physical box, as its tiles do. */
Imath::V3i64 cell_of(const rg_grid_report &grid, uint32_t level, const V3d &place) {
    Imath::V3i64 cell;
    for (int axis = 0; axis < 3; ++axis)
        cell[axis] = int64_t(std::floor((place[axis] - grid.physical_lo[axis]) / cell_width(grid, level, axis)));
    return cell;
}

} // namespace

double cell_width(const rg_grid_report &grid, uint32_t level, int axis) {
    return (grid.physical_hi[axis] - grid.physical_lo[axis]) / std::max(1u, grid.resolution[axis] >> level);
}

uint8_t level_of(const rg_grid_report &grid, const double lo[3], const double hi[3]) {
    const auto fits = [&](uint32_t level) {
        for (int axis = 0; axis < 3; ++axis)
            if (!(hi[axis] - lo[axis] <= cell_width(grid, level, axis))) return false;
        return true;
    };
    const bool finite = hi[0] - lo[0] < HUGE_VAL && hi[1] - lo[1] < HUGE_VAL && hi[2] - lo[2] < HUGE_VAL;
    if (grid.kind == RG_GRID_UNIFORM && grid.levels > 0 && finite) return 0;
    if (grid.kind != RG_GRID_HIERARCHICAL) return no_level;
    for (uint32_t level = 0; level < grid.levels; ++level)
        if (fits(level)) return uint8_t(level);
    return no_level;
}

/* ------------------------------------------------------------------------------------------------ survey */

void Overlay::survey(const World &world, const Pass &pass, const Overlays &overlays) {
    grid_ = world.grid();
    if (overlays.heat) survey_heat(pass);
    if (overlays.levels || overlays.cells) survey_levels(world, pass);
}

/* The scale ends at a power of two above all but the hottest hundredth, so that it does not change all the time. */
void Overlay::survey_heat(const Pass &pass) {
    heat_.resize(pass.pixels());
    uint64_t sum = 0;
    for (size_t pixel = 0; pixel < pass.pixels(); ++pixel) {
        heat_[pass.place(pixel)] = pass.cells[pixel];
        sum += pass.cells[pixel];
    }
    mean_heat_ = double(sum) / double(pass.pixels());
    std::vector<uint32_t> sorted = heat_;
    const auto hot = sorted.begin() + ptrdiff_t(sorted.size() * 99 / 100);
    std::nth_element(sorted.begin(), hot, sorted.end());
    for (hottest_ = 1; hottest_ < *hot;) hottest_ *= 2;
}

void Overlay::survey_levels(const World &world, const Pass &pass) {
    constexpr uint8_t unknown = 254;
    std::vector<uint8_t> of_slot;
    levels_.assign(pass.pixels(), no_level);
    levels_seen_ = 0;
    for (size_t pixel = 0; pixel < pass.pixels(); ++pixel) {
        if (!pass.hit(pixel)) continue;
        const uint32_t slot = RG_OBJECT_SLOT(pass.objects[pixel]);
        if (slot >= of_slot.size()) of_slot.resize(slot + size_t(1), unknown);
        if (of_slot[slot] == unknown) {
            rg_object_report object = {};
            object.size = sizeof object;
            check(rg_scene_lookup(world.scene(), pass.objects[pixel], &object));
            of_slot[slot] = level_of(grid_, object.lo, object.hi);
            if (of_slot[slot] != no_level) levels_seen_ |= 1u << of_slot[slot];
        }
        levels_[pass.place(pixel)] = of_slot[slot];
    }
}

/* ------------------------------------------------------------------------------------------------ drawing */

void Overlay::draw_heat(Canvas &canvas) const {
    crew_.run(heat_.size(), [&](size_t first, size_t end) {
        for (size_t pixel = first; pixel < end; ++pixel)
            canvas.cover(pixel, heat_colour(double(heat_[pixel]) / hottest_), 0.92f);
    });
}

void Overlay::draw_levels(Canvas &canvas) const {
    crew_.run(levels_.size(), [&](size_t first, size_t end) {
        for (size_t pixel = first; pixel < end; ++pixel)
            if (levels_[pixel] != no_level) canvas.cover(pixel, level_colour(levels_[pixel]), 0.6f);
    });
}

/* A wall is between two pixels of one object that are in different cells. */
void Overlay::draw_cells(Canvas &canvas, const Camera &camera, const Picture &picture) const {
    const uint32_t width = picture.width;
    const auto cell_at = [&](size_t pixel) {
        const double x = double(pixel % width) + 0.5, y = double(pixel / width) + 0.5;
        return cell_of(grid_, levels_[pixel], camera.place(x, y, picture.depth[pixel]));
    };
    const auto is_wall = [&](size_t pixel, size_t neighbour) {
        return picture.id[neighbour] == picture.id[pixel] && cell_at(neighbour) != cell_at(pixel);
    };
    crew_.run(levels_.size(), [&](size_t first, size_t end) {
        for (size_t pixel = first; pixel < end; ++pixel) {
            if (levels_[pixel] == no_level) continue;
            const bool right = pixel % width + 1 < width && is_wall(pixel, pixel + 1);
            const bool below = pixel + width < levels_.size() && is_wall(pixel, pixel + width);
            if (right || below) canvas.cover(pixel, level_colour(levels_[pixel]), 0.9f);
        }
    });
}

void Overlay::draw(Canvas &canvas, const World &world, const Overlays &overlays, const Camera &camera,
                   const Picture &picture, rg_object held) const {
    if (overlays.heat) draw_heat(canvas);
    if (overlays.levels) draw_levels(canvas);
    if (overlays.cells) draw_cells(canvas, camera, picture);
    if (overlays.boxes) {
        if (grid_.logical_lo[0] <= grid_.logical_hi[0])
            canvas.draw_box(grid_.logical_lo, grid_.logical_hi, camera, picture, logical_colour);
        if (grid_.levels > 0 && grid_.physical_lo[0] < grid_.physical_hi[0])
            canvas.draw_box(grid_.physical_lo, grid_.physical_hi, camera, picture, physical_colour);
    }
    if (held == RG_NO_OBJECT) return;
    rg_object_report object = {};
    object.size = sizeof object;
    check(rg_scene_lookup(world.scene(), held, &object));
    canvas.draw_box(object.lo, object.hi, camera, picture, held_colour);
}

/* ------------------------------------------------------------------------------------------------- legend */

void Overlay::write_legend(Canvas &canvas, const Overlays &overlays, const Letters &letters) const {
    int y = int(canvas.height()) - letters.height() - 4;
    const auto write = [&](const Colour &colour, const std::string &line) {
        letters.write(canvas, 8, y, line, colour);
        y -= letters.height();
    };
    char line[160];
    if (overlays.heat) {
        for (int x = 0; x < 128 && 8 + x < int(canvas.width()); ++x)
            for (int row = 0; row < 8 && y - row >= 0; ++row)
                canvas.cover(size_t(y + 8 - row) * canvas.width() + size_t(8 + x), heat_colour(x / 127.0), 1);
        y -= letters.height();
        std::snprintf(line, sizeof line, "cells a ray looks into: 0 to %u, mean %.1f", unsigned(hottest_),
                      mean_heat_);
        write(Colour(1), line);
    }
    const bool has_levels = grid_.kind != RG_GRID_LOOSE;
    if ((overlays.levels || overlays.cells) && !has_levels)
        write(Colour(1), "a loose grid tells of no cells: see the heat");
    for (uint32_t level = 0; (overlays.levels || overlays.cells) && level < grid_.levels && has_levels; ++level) {
        if (!(levels_seen_ >> level & 1)) continue;
        std::snprintf(line, sizeof line, "level %u: cells of %.3g x %.3g x %.3g", unsigned(level),
                      cell_width(grid_, level, 0), cell_width(grid_, level, 1), cell_width(grid_, level, 2));
        write(level_colour(level), line);
    }
    if (!overlays.boxes) return;
    write(logical_colour, "logical box");
    if (grid_.levels > 0 && has_levels) write(physical_colour, "physical box");
}

} // namespace viewer
