/* SPDX-License-Identifier: MIT */
/*
 * overlay.h: what a grid does, drawn over the picture.
 *
 * All of it is what the public interface tells: boxes and cell sizes from rg_grid_report, the level of an object from
 * the rule that raygrid/grid.h states and the box that rg_scene_lookup gives, cells visited from the `cells` of a
 * trace. Grids of the loose kind have no cells that a report tells of: of them the logical box and the heat are
 * shown.
 */
#ifndef VIEWER_OVERLAY_H
#define VIEWER_OVERLAY_H

#include "options.h"
#include "render.h"
#include "window.h"
#include "world.h"

namespace viewer {

/** Level of nothing, of what no cell holds, and of all in grids that do not tell. */
constexpr uint8_t no_level = 255;

/** Width of the cells of a level along an axis. */
double cell_width(const rg_grid_report &grid, uint32_t level, int axis);

/** The level of cells at which a grid of the paper's kinds lists what fills a box. */
uint8_t level_of(const rg_grid_report &grid, const double lo[3], const double hi[3]);

class Overlay {
  public:
    explicit Overlay(demo::Crew &crew) : crew_(crew) {}

    /** Looks into a pass through the centres of the pixels. */
    void survey(const World &world, const demo::Pass &pass, const Overlays &overlays);

    /** Draws what is wanted of the last survey, text excepted. `held` has its box drawn, too. */
    void draw(Canvas &canvas, const World &world, const Overlays &overlays, const demo::Camera &camera,
              const demo::Picture &picture, rg_object held) const;

    /** What the colours mean: lines at the lower left. */
    void write_legend(Canvas &canvas, const Overlays &overlays, const Letters &letters) const;

  private:
    void survey_heat(const demo::Pass &pass);
    void survey_levels(const World &world, const demo::Pass &pass);
    void draw_heat(Canvas &canvas) const;
    void draw_levels(Canvas &canvas) const;
    void draw_cells(Canvas &canvas, const demo::Camera &camera, const demo::Picture &picture) const;

    demo::Crew &crew_;
    rg_grid_report grid_ = {};
    std::vector<uint32_t> heat_; /* cells visited; by pixel, row by row */
    uint32_t hottest_ = 1;       /* where the scale ends */
    double mean_heat_ = 0;
    std::vector<uint8_t> levels_; /* by pixel, row by row */
    uint32_t levels_seen_ = 0;    /* bit l for level l */
};

} // namespace viewer

#endif
