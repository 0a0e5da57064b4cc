/* SPDX-License-Identifier: MIT */
/* common.h: what the stress tests share: memory that is counted from any thread, failures, and the command line. */
#ifndef RAYGRID_TESTS_STRESS_COMMON_H
#define RAYGRID_TESTS_STRESS_COMMON_H

#include <raygrid/raygrid.h>
#include <stdbool.h>

/** What an allocator has given out. All of it is changed atomically. */
struct books {
    uint64_t bytes, peak;
    int64_t blocks_left; /* that it still gives; below 0: all */
};

rg_allocator books_hooks(struct books *books);

/** Where to begin counting the peak anew. */
void books_reset_peak(struct books *books);

/** Prints what does not hold, with the library's message, and ends the process. */
void demand(bool holds, const char *what);

/** demand() that a call succeeds. */
#define MUST(call) demand((call) == RG_OK, #call)

/** What follows `name` on the command line, else `otherwise`. */
uint64_t option(int argc, char **argv, const char *name, uint64_t otherwise);

/** A scene whose own grid is of that kind. */
rg_scene *create_scene(struct books *books, rg_grid_kind kind, uint32_t workers);

/** Ends a scene, and demands that all memory came back. */
void destroy_scene(struct books *books, rg_scene **scene);

rg_grid_report report_grid(rg_scene *scene);

extern const rg_grid_kind KINDS[3];
const char *kind_name(rg_grid_kind kind);

#endif
