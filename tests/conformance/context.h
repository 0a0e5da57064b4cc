/* SPDX-License-Identifier: MIT */
/* What the runner knows while it plays a case: where it is, what has a name, and what went wrong. */
#ifndef CONFORMANCE_CONTEXT_H
#define CONFORMANCE_CONTEXT_H

#include <raygrid/raygrid.h>

#include <jansson.h>
#include <stdbool.h>

/** No library call was made, because the step can't be read. */
#define MALFORMED ((rg_result)-1)

/** A name in a script. Objects may be many: name[0], name[1] ... */
typedef struct named {
    char *name;
    uint64_t *values; /* ids of objects, or the id of a grid */
    size_t count;
    bool many;
    rg_shape *shape;
} named;

typedef struct names {
    named *items;
    size_t count, room;
} names;

/** One way to set up the scene's own grid. */
typedef struct setup {
    const char *name;
    rg_grid_kind kind;
    bool tiled;   /* a small box that is never rebuilt: nearly everything lies in other tiles */
    bool rebuilt; /* rebuilt before each trace: the cells always fit */
} setup;

struct batch;

typedef struct context {
    const char *name; /* of the case */
    const setup *setup;
    uint32_t workers;
    bool costly;
    size_t step;
    const char *path; /* of a trace; NULL elsewhere */
    long ray;         /* -1: none */
    unsigned failures;
    bool broken; /* a step can't be read: the rest of the case is not played */
    rg_scene *scene;
    names shapes, objects, grids;
    struct batch *last; /* the last trace, for comparison after errors */
} context;

/** Counts a failure of the case and prints it with the place in the script. */
void fail(context *c, const char *format, ...);

/** A failure after which the case can't go on: the script is not what the schema says. */
void malformed(context *c, const char *format, ...);

void names_free(names *n);

/** The entry of a name, or NULL. */
named *names_find(const names *n, const char *name);

/** A new or emptied entry of that name, with room for `count` values. */
named *names_add(names *n, const char *name, size_t count);

/** What an id is called, for messages; the text holds until the next call. */
const char *object_name(const context *c, rg_object id);

#endif
