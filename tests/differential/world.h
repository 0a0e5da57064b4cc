/* SPDX-License-Identifier: MIT */
/*
 * world.h: one random scene, kept twice: in the library and in the reference. Every change goes to both, every query
 * is put to both, and a difference ends the test with all that is needed to repeat it.
 */
#ifndef RAYGRID_TESTS_WORLD_H
#define RAYGRID_TESTS_WORLD_H

#include "batches.h"
#include "random.h"
#include "reference.h"

#include <stddef.h>

enum { WORLD_SHAPES = 32, WORLD_GRIDS = 4, WORLD_STALE = 64, WORLD_BATCH = 40, WORLD_MANY = 2000 };

typedef struct world_shape {
    rg_shape *shape;
    const reference_shape *reference;
    bool finite; /* infinite boxes take plain poses only */
    bool ball;
    bool rare; /* in the way of most rays: one in a scene will do */
} world_shape;

/** What a user-defined shape gets: the reference stands in for the host's code. */
typedef struct world_user {
    const reference_shape *shape;
    int *alive;
} world_user;

/** What the queries found so far. */
typedef struct world_counts {
    uint64_t rays, hits, occluded, within_bound, reflected;
    long double worst_t;      /* error of t as a part of its bound */
    long double worst_normal; /* length of the difference */
} world_counts;

typedef struct world {
    const char *name; /* for messages */
    uint64_t seed, step;
    random_source random;
    rg_scene *scene;
    reference_scene *reference;
    world_shape shapes[WORLD_SHAPES];
    world_user users[WORLD_SHAPES]; /* entry i belongs to shape i, if that is user-defined */
    int shape_count, users_alive;
    rg_grid grids[WORLD_GRIDS];
    int grid_count;
    uint64_t rebuilds[WORLD_GRIDS]; /* that were asked for */
    bool configures;                /* grids change their kind now and then */
    bool balls;                     /* nothing but spheres, whole ones, which every ray sees */
    bool all_finite;                /* no infinite boxes, and no masks */
    uint32_t most_at_once;          /* objects of a call on many: up to WORLD_MANY */
    uint32_t many_of_16;            /* of 16 steps so many are calls on many, not counting the usual ones */
    bool no_cells_for_finite;       /* sizes differ so much that finite objects may be without a cell */
    uint32_t most_objects;          /* at one time, for rg_scene_report.slots */
    double centre[3], spread;       /* where poses are drawn from */
    int least_decade, most_decade;  /* of the sizes, as powers of ten */
    rg_object stale[WORLD_STALE];
    uint32_t removed; /* all so far; the last WORLD_STALE of them are in `stale` */
    uint64_t invalid_rays;
    world_counts counts;
} world;

/** Makes both scenes empty, and the shapes; and `more_count` grids besides the scene's own. */
void world_create(world *w, const char *name, uint64_t seed, const rg_scene_config *config,
                  const rg_grid_config *more, int more_count);

/** Removes everything, destroys both scenes, checks that every shape died. */
void world_destroy(world *w);

/** Says what is wrong, where, and how to get there again; then ends the process with status 1. */
void world_fail(const world *w, const char *format, ...);

/** Fails unless `got` is `want`; `call` names what returned it. */
void world_expect(const world *w, const char *call, rg_result got, rg_result want);

/* shapes.c */
void world_make_shapes(world *w);
rg_pose world_pose(world *w, const world_shape *shape);
rg_mesh_views world_mesh_views(const double *vertices, size_t vertex_count, const uint32_t *indices,
                               size_t triangle_count);

/* steps.c: one random change each */
void world_insert_one(world *w);
void world_insert_many(world *w, uint32_t count);
void world_move_one(world *w);
void world_move_many(world *w, uint32_t count);
void world_remove_one(world *w);
void world_remove_many(world *w, uint32_t count);
void world_replace_shape(world *w);
/** Any of these, the population held near `population`; also masks, rebuilds, and calls that must fail. */
void world_step(world *w, uint32_t population);
/** Gives a grid a random configuration of any kind. */
void world_configure(world *w);
/** Some live object. There must be one. */
rg_object world_pick(world *w);

/* rays.c */
rg_ray world_ray(world *w);
/** Lone rays, or neighbours: see batches.h. */
void world_rays(world *w, rg_ray *rays, uint32_t count);

/* queries.c: each puts `count` random rays to both */
void world_query_plain(world *w, uint32_t count);
void world_query_shadows(world *w, uint32_t count);  /* neighbours, and rays from what they hit to a light */
void world_query_views(world *w, uint32_t count);    /* by views, with culling */
void world_query_filtered(world *w, uint32_t count); /* with a filter, and culling */

/* books.c: stats, lookups, bounds, stale ids */
void world_check_books(world *w);
/** What is only right just after a rebuild: boxes are tight. */
void world_check_rebuilt(const world *w, int grid);

void world_dump_ray(const rg_ray *ray);
void world_dump_object(const world *w, const char *which, rg_object id);

#endif
