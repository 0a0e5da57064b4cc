/* SPDX-License-Identifier: MIT */
/*
 * animation.h: the evaluation's scenes, and the paths laid down for their bodies.
 *
 * At time 0 all are in the unit cube. "flake": a sphere flake whose spheres fly apart, each away from the middle,
 * some faster than others. "crowd": small turned meshes, their sizes 1:100, each along a line of its own and swinging
 * about it. "equal": spheres of one size, evenly spread, that swing about where they are. "escape": the same spheres
 * stand still, but for one in a hundred, which goes far away. "engine": the parts of the demo's glTF model, taken
 * apart; only where the demo is built.
 */
#ifndef RAYGRID_BENCH_EVALUATION_ANIMATION_H
#define RAYGRID_BENCH_EVALUATION_ANIMATION_H

#include "rays.h"
#include "scenes.h"

struct animation {
    struct bench_scene *bodies; /* as they are now */
    uint32_t moving;            /* the first so many; the others stand still */
    double (*ways)[3];          /* what each has moved along its line at time 1 */
    double (*swings)[3];        /* how far it swings to either side */
    double growth;              /* at time 1 the camera looks at a scene so many cubes larger on each axis */
};

/** As many bodies as asked for; the engine has its own number. NULL if there is no such scene here. */
struct animation *animation_create(const char *name, uint32_t count);
void animation_destroy(struct animation *animation);

/** Takes all bodies to where they are at that time. */
void animation_go(struct animation *animation, double time);

/** A camera's rays at the unit cube, made to look at all of the scene at that time from as much farther away. */
void animation_look(const struct animation *animation, double time, const struct bench_rays *cube,
                    struct bench_rays *rays);

#endif
