/* SPDX-License-Identifier: MIT */
/* The numbers by which a snapshot or recording knows shapes: 0, 1, 2 in the order in which they are met. */
#ifndef RAYGRID_LIB_SHAPE_NUMBERS_H
#define RAYGRID_LIB_SHAPE_NUMBERS_H

#include "memory.h"

#include <raygrid/shape.h>

#include <stdbool.h>

/** Holds a reference to each shape, so that no other comes to lie at its address. */
typedef struct rgi_shape_numbers {
    rgi_memory *memory;
    struct rgi_numbered *table; /* by address; its room is a power of two, and never full */
    uint64_t room;
    uint32_t count;
} rgi_shape_numbers;

void rgi_shape_numbers_init(rgi_shape_numbers *numbers, rgi_memory *memory);

/** Gives the references back: the scene must not be held. */
void rgi_shape_numbers_free(rgi_shape_numbers *numbers);

/** Whether the shape has a number. */
bool rgi_shape_numbers_find(const rgi_shape_numbers *numbers, const rg_shape *shape, uint32_t *number);

/** Gives the next number to a shape that has none. RG_OUT_OF_MEMORY: nothing has changed. */
rg_result rgi_shape_numbers_add(rgi_shape_numbers *numbers, rg_shape *shape, uint32_t *number);

#endif
