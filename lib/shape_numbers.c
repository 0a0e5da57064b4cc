/* SPDX-License-Identifier: MIT */
#include "shape_numbers.h"

#include <string.h>

typedef struct rgi_numbered {
    rg_shape *shape; /* NULL: free */
    uint32_t number;
} rgi_numbered;

enum { FIRST_ROOM = 16 };

void rgi_shape_numbers_init(rgi_shape_numbers *n, rgi_memory *memory) {
    memset(n, 0, sizeof *n);
    n->memory = memory;
}

void rgi_shape_numbers_free(rgi_shape_numbers *n) {
    for (uint64_t i = 0; i < n->room; i++) rg_shape_release(&n->table[i].shape);
    rgi_release(n->memory, n->table, n->room, sizeof *n->table);
    rgi_shape_numbers_init(n, n->memory);
}

/* The place of a shape, or the free one where it belongs. Addresses differ in their middle bits: multiplied by 2^64 /
 * golden ratio, these are spread over the upper half. */
static rgi_numbered *place_of(const rgi_shape_numbers *n, const rg_shape *shape) {
    uint64_t at = ((uint64_t)(uintptr_t)shape * UINT64_C(0x9e3779b97f4a7c15)) >> 32;
    while (n->table[at & (n->room - 1)].shape && n->table[at & (n->room - 1)].shape != shape) at++;
    return &n->table[at & (n->room - 1)];
}

bool rgi_shape_numbers_find(const rgi_shape_numbers *n, const rg_shape *shape, uint32_t *number) {
    if (!n->room) return false;
    const rgi_numbered *place = place_of(n, shape);
    *number = place->number;
    return place->shape != NULL;
}

static rg_result grow(rgi_shape_numbers *n) {
    rgi_shape_numbers larger = *n;
    larger.room = n->room ? 2 * n->room : FIRST_ROOM;
    rg_result result =
        rgi_allocate(n->memory, larger.room, sizeof *larger.table, "the numbers of shapes", &larger.table);
    if (result) return result;
    memset(larger.table, 0, larger.room * sizeof *larger.table);
    for (uint64_t i = 0; i < n->room; i++) {
        if (n->table[i].shape) *place_of(&larger, n->table[i].shape) = n->table[i];
    }
    rgi_release(n->memory, n->table, n->room, sizeof *n->table);
    *n = larger;
    return RG_OK;
}

rg_result rgi_shape_numbers_add(rgi_shape_numbers *n, rg_shape *shape, uint32_t *number) {
    if (2 * (uint64_t)n->count >= n->room) {
        rg_result result = grow(n);
        if (result) return result;
    }
    *number = n->count++;
    rg_shape_retain(shape);
    *place_of(n, shape) = (rgi_numbered){shape, *number};
    return RG_OK;
}
