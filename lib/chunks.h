/* SPDX-License-Identifier: MIT */
/*
 * Chunks of memory of one size, by number, whose addresses never change. Few chunks are allocated one by one; once
 * they are many, in slabs of as many huge pages as fit, so that a large scene costs few misses of the processor's
 * address tables.
 */
#ifndef RAYGRID_LIB_CHUNKS_H
#define RAYGRID_LIB_CHUNKS_H

#include "memory.h"

#include <stdbool.h>

typedef struct rgi_chunks {
    rgi_memory *memory;
    char **at;
    uint32_t count;
    uint32_t room;  /* pointers that `at` has room for */
    uint32_t slab;  /* number of the first chunk of the last slab */
    uint32_t bytes; /* of a chunk */
    bool bulk;      /* they are added for many records at once: on huge pages */
    uint32_t freed; /* chunks that were given back, from the first on, see rgi_chunks_free_some */
} rgi_chunks;

/** Bytes that may be read, but not written, behind a chunk: kernels load whole vectors. */
enum { RGI_SLACK = 64 };

void rgi_chunks_init(rgi_chunks *chunks, rgi_memory *memory, uint32_t bytes);
void rgi_chunks_free(rgi_chunks *chunks);

/** Frees so many of the blocks that chunks are in. From the first time on nothing else may be done but to free more.
 * Returns whether there are more. */
bool rgi_chunks_free_some(rgi_chunks *chunks, uint32_t blocks);

/** Adds a chunk, not cleared. RG_OUT_OF_MEMORY: nothing has changed. */
rg_result rgi_chunks_add(rgi_chunks *chunks, const char *purpose);

#endif
