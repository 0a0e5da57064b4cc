/* SPDX-License-Identifier: MIT */
/* Memory from the host's allocator, counted. Every byte that the library holds comes through here. */
#ifndef RAYGRID_LIB_MEMORY_H
#define RAYGRID_LIB_MEMORY_H

#include <raygrid/base.h>

/** Bytes of what systems call a huge page. */
enum { RGI_HUGE_PAGE = 1 << 21 };

typedef struct rgi_memory {
    rg_allocator allocator;
    uint64_t bytes; /* held now; read and written atomically */
    uint64_t limit; /* of them */
} rgi_memory;

/** Takes over the host's allocator, or malloc if `allocator` is NULL or empty; RG_INVALID_ARGUMENT if it is half
 * given. */
rg_result rgi_memory_init(rgi_memory *memory, const rg_allocator *allocator);

/**
 * count * size bytes, if they are within the limit, for what the message calls `purpose`, not cleared.
 * RG_OUT_OF_MEMORY, also if the product overflows; *out is then as it was.
 */
rg_result rgi_allocate(rgi_memory *memory, uint64_t count, size_t size, const char *purpose, void *out);

/**
 * Asks for huge pages for a block that was just allocated: a wish, whose failure changes nothing. Not for what single
 * changes allocate: where the system has no huge page at hand, it may take tens of milliseconds to make one, at the
 * first touch.
 */
void rgi_wish_huge_pages(const rgi_memory *memory, void *block, size_t bytes);

/** Gives back what rgi_allocate returned for the same count and size. NULL is ignored. */
void rgi_release(rgi_memory *memory, void *block, uint64_t count, size_t size);

#endif
