/* SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 200809L
#include "common.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* -------------------------------------------------------------------------------------------------- memory */

static bool may_give(struct books *books) {
    int64_t left = __atomic_load_n(&books->blocks_left, __ATOMIC_RELAXED);
    while (left > 0) {
        if (__atomic_compare_exchange_n(&books->blocks_left, &left, left - 1, false, __ATOMIC_RELAXED,
                                        __ATOMIC_RELAXED))
            return true;
    }
    return left < 0;
}

static void *allocate(void *user, size_t size, size_t alignment) {
    struct books *books = user;
    void *block;
    /* What posix_memalign asks for is no more than what the library may. */
    size_t least = alignment < sizeof(void *) ? sizeof(void *) : alignment;
    if (!may_give(books) || posix_memalign(&block, least, size)) return NULL;
    uint64_t bytes = __atomic_add_fetch(&books->bytes, size, __ATOMIC_RELAXED);
    uint64_t peak = __atomic_load_n(&books->peak, __ATOMIC_RELAXED);
    while (bytes > peak &&
           !__atomic_compare_exchange_n(&books->peak, &peak, bytes, false, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
    }
    return block;
}

static void release(void *user, void *block, size_t size, size_t alignment) {
    struct books *books = user;
    (void)alignment;
    __atomic_fetch_sub(&books->bytes, size, __ATOMIC_RELAXED);
    free(block);
}

rg_allocator books_hooks(struct books *books) {
    books->blocks_left = -1;
    return (rg_allocator){books, allocate, release};
}

void books_reset_peak(struct books *books) {
    __atomic_store_n(&books->peak, __atomic_load_n(&books->bytes, __ATOMIC_RELAXED), __ATOMIC_RELAXED);
}

/* ------------------------------------------------------------------------------------------------ failures */

void demand(bool holds, const char *what) {
    if (holds) return;
    fprintf(stderr, "FAILED: %s; message: %s\n", what, rg_error_message());
    exit(EXIT_FAILURE);
}

uint64_t option(int argc, char **argv, const char *name, uint64_t otherwise) {
    for (int i = 1; i + 1 < argc; i++) {
        if (strcmp(argv[i], name) == 0) return strtoull(argv[i + 1], NULL, 0);
    }
    return otherwise;
}

/* -------------------------------------------------------------------------------------------------- scenes */

const rg_grid_kind KINDS[3] = {RG_GRID_UNIFORM, RG_GRID_HIERARCHICAL, RG_GRID_LOOSE};

const char *kind_name(rg_grid_kind kind) {
    static const char *const names[] = {"default", "uniform", "hierarchical", "loose"};
    return names[kind];
}

rg_scene *create_scene(struct books *books, rg_grid_kind kind, uint32_t workers) {
    const rg_grid_config grid = {.size = sizeof grid, .kind = kind};
    const rg_scene_config config = {
        .size = sizeof config, .workers = workers, .grid = &grid, .allocator = books_hooks(books)};
    rg_scene *scene = NULL;
    MUST(rg_scene_create(&config, &scene));
    return scene;
}

void destroy_scene(struct books *books, rg_scene **scene) {
    MUST(rg_scene_destroy(scene));
    demand(!*scene, "the pointer to a scene is NULL once it is destroyed");
    demand(books->bytes == 0, "all memory of a scene comes back");
}

rg_grid_report report_grid(rg_scene *scene) {
    rg_grid_report report = {.size = sizeof report};
    MUST(rg_grid_stats(scene, RG_GRID_OF_SCENE, &report));
    return report;
}
