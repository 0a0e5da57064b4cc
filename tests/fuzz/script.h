/* SPDX-License-Identifier: MIT */
/* script.h: bytes read as a script of calls. The files of the interpreter share this. */
#ifndef RAYGRID_TESTS_SCRIPT_H
#define RAYGRID_TESTS_SCRIPT_H

#include "reference.h"

#include <stddef.h>

enum { MOST_SHAPES = 12, MOST_OBJECTS = 48, MOST_GRIDS = 4, MOST_STEPS = 150, MANY = 6 };

/** What a user-defined shape's callback does. */
typedef enum misdeed {
    NO_MISDEED, /* asks the reference */
    FAILS,
    RETURNS_NAN,
    RETURNS_NONSENSE, /* a t out of the range, an odd normal */
    CHANGES_SCENE,    /* and demands RG_BUSY */
    TRACES_SCENE,
    MISDEEDS
} misdeed;

typedef struct script script;

typedef struct script_user {
    script *script;
    const reference_shape *reference;
    misdeed misdeed;
    int destroyed;
} script_user;

typedef struct script_shape {
    rg_shape *shape;
    const reference_shape *reference;
    script_user *user;
    bool wild; /* its numbers differ by more powers of two than a double has digits: taken, but not judged */
} script_shape;

struct script {
    const uint8_t *bytes, *end;
    rg_scene *scene;
    reference_scene *reference;
    script_shape shapes[MOST_SHAPES];
    int shape_count;
    script_user users[MOST_SHAPES];
    rg_object objects[MOST_OBJECTS]; /* live and stale ones; 0 where there never was one */
    bool misbehaves[MOST_OBJECTS];   /* a user-defined shape that does not report what the reference knows */
    bool wild[MOST_OBJECTS];
    int object_count;
    rg_grid grids[MOST_GRIDS];
    int grid_count;
    int depth; /* of traces from inside callbacks */
    bool filter_fails;
};

/** Ends the process: what the library did is not what its header says. */
void script_fail(const char *why);
/** A result that the header knows; and a failure has a message. */
rg_result script_check(rg_result result);

/* bytes.c: what is read past the end is 0 */
uint8_t read_byte(script *s);
uint32_t read_below(script *s, uint32_t n);
/** Mostly a small round number, now and then the worst there is. */
double read_number(script *s);
float read_float(script *s);
size_t read_size(script *s, size_t right);
rg_pose read_pose(script *s);
rg_ray read_ray(script *s);
rg_grid_config read_grid_config(script *s);
/** A live, a stale, or a made-up id. */
rg_object read_object(script *s);
rg_grid read_grid(script *s);

/* shapes.c */
void make_a_shape(script *s);
void release_a_shape(script *s);

/* calls.c: one call each, with whatever the bytes say */
typedef void script_step(script *s);
script_step insert_one, insert_some, move_one, move_to, move_some, set_mask, remove_one, remove_some, look_up,
    ask_stats, create_grid, destroy_grid, configure_grid, rebuild_grid, pass_null;

/* traces.c */
script_step trace_plain, trace_views, occluded_views;
/** Some rays through the scene as it is in the end, judged by the reference. */
void script_judge(script *s);

#endif
