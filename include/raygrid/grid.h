/* SPDX-License-Identifier: MIT */
/*
 * raygrid/grid.h: the grids of a scene.
 *
 * A scene has one grid from the start, RG_GRID_OF_SCENE, and nobody needs to know of it. A host may add more, each of
 * its own kind, for instance one for what never moves. Every object is in exactly one; a trace goes through all.
 *
 * The default kind is RG_GRID_LOOSE, see there. The other two follow E. Reinhard, B. Smits, C. Hansen, "Dynamic
 * Acceleration Structures for Interactive Ray Tracing" (Eurographics Workshop on Rendering 2000, the parts on grids
 * and on hierarchical grids):
 *   - The physical box is where the cells are. Space is tiled by copies of it: a place outside has the cell at the
 *     same place in its own tile, so an object that leaves the box re-enters on the other side. Each entry of a cell
 *     carries its tile, and a ray passes over entries of other tiles.
 *   - The logical box holds all objects. It grows at once when an object leaves it; a ray ends where it leaves it.
 *   - When the diagonal of the logical box is more than `rebuild_factor` times that of the physical box, or when the
 *     number of objects has outgrown an automatic resolution, the grid is rebuilt with a box that fits.
 * Grids of all kinds that rebuild themselves do so beside what serves traces and changes: on a worker of the scene
 * that has nothing else to do, or, in a scene without workers, bit by bit in the calls that change it. Until the new
 * grid takes the place of the old one, all answers are as right as ever. Only a grid of few objects, or one to which
 * a single call adds a quarter of its objects or more, is rebuilt in that call. Without memory for it, a grid serves
 * on as it is. A grid without a box of its own has no cells as long as it holds only a few objects: testing each
 * costs less.
 */
#ifndef RAYGRID_GRID_H
#define RAYGRID_GRID_H

#include <raygrid/base.h>
#include <raygrid/shape.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A grid of a scene, by value. Carries a generation: the id of a destroyed grid is refused. */
typedef uint32_t rg_grid;

/** The grid that a scene has from the start. It can't be destroyed. */
#define RG_GRID_OF_SCENE ((rg_grid)0)

/** How a grid stores its objects. */
typedef int32_t rg_grid_kind;

enum {
    /** What suits most scenes: the loose kind. */
    RG_GRID_DEFAULT = 0,
    /** One level of cells; an object is listed in every cell that it overlaps. For objects of like size. */
    RG_GRID_UNIFORM = 1,
    /**
     * Levels of cells, each twice as wide as the level below; an object is listed at the level whose cells are no
     * smaller than it, so in at most 8 cells. Insert, move and remove cost the same whatever the sizes.
     */
    RG_GRID_HIERARCHICAL = 2,
    /**
     * A lattice of cells, each half as wide as the one above it, made where objects are. An object is stored once, by
     * its centre, in a cell that fits its size; tight boxes around what is stored decide what a ray looks into. Cells
     * hold floats, relative to an origin and a unit that were chosen from the objects. It has no box that objects
     * could leave: resolution, lo, hi and rebuild_factor have no meaning, and it is made anew by itself only when all
     * objects have drifted four radii of the whole away from that origin, or when many are out of floats' reach.
     */
    RG_GRID_LOOSE = 3
};

/** For rebuild_factor: never rebuild by itself. */
#define RG_REBUILD_NEVER (-1.0)

/** How a grid is made. */
typedef struct rg_grid_config {
    size_t size;
    rg_grid_kind kind;
    /**
     * Cells along the longest side of the physical box, at the finest level; the other sides have as many as fit, at
     * least one. The hierarchical kind rounds up to a power of two on each side. 0: from the number of objects, anew
     * at each rebuild. At most 2^20; and at most 2^28 cells in all.
     */
    uint32_t resolution;
    /**
     * The first physical box; hi - lo at least RG_RADIUS_MIN. All six 0: from the objects, when the first are
     * inserted. A rebuild makes a new box from the objects, unless it only adapts an automatic resolution: then a box
     * that was given stays.
     */
    double lo[3], hi[3];
    /**
     * Rebuild when the logical diagonal exceeds the physical one by this factor: >= 1, 0 for the default of 2, or
     * RG_REBUILD_NEVER. An automatic resolution is also adapted at such times, never with RG_REBUILD_NEVER.
     */
    double rebuild_factor;
} rg_grid_config;

/**
 * Fills `config` with the defaults: RG_GRID_DEFAULT, automatic resolution and box, factor 2. `size` is
 * sizeof(rg_grid_config) at the caller's. RG_INVALID_ARGUMENT: config is NULL or the size unknown.
 */
RG_API rg_result rg_grid_config_default(rg_grid_config *config, size_t size);

/** What is known of a grid. Set `size` before the call; the library fills what both sides know. */
typedef struct rg_grid_report {
    size_t size;
    rg_grid_kind kind;                     /* never RG_GRID_DEFAULT: the kind that it stands for */
    uint32_t levels;                       /* levels of cells; 0 while there is no physical box yet */
    uint32_t levels_used;                  /* bit l set: level l, counted from the finest, holds objects */
    uint32_t resolution[3];                /* cells of the finest level, each axis */
    double physical_lo[3], physical_hi[3]; /* where the cells are; zero while there is none */
    double logical_lo[3], logical_hi[3];   /* holds all finite objects; lo > hi while there are none */
    uint64_t objects;                      /* objects in this grid */
    uint64_t entries;                      /* places in cells that they take, all together */
    uint64_t unbounded;                    /* objects that no cell can hold (infinite, or larger than the physical
                                              box), tested for every ray */
    uint64_t tiles;                        /* tiles of the physical box that hold something; 1 if nothing left it */
    uint64_t rebuilds;   /* how often it was rebuilt: by itself, rg_grid_rebuild, rg_grid_configure */
    uint32_t rebuilding; /* 1 from when another is begun beside it until the memory of the old one is freed, else 0 */
    uint32_t reserved;   /* 0 */
} rg_grid_report;

#ifdef __cplusplus
}
#endif
#endif
