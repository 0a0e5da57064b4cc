/* SPDX-License-Identifier: MIT */
/*
 * Records of one size with small indices and addresses that never change: chunks of 1024, and a list of the free.
 * Each record starts with a uint32_t that belongs to the list while the record is free.
 */
#ifndef RAYGRID_LIB_SLOTS_H
#define RAYGRID_LIB_SLOTS_H

#include "chunks.h"

#include <stdint.h>
#include <string.h>

enum { RGI_CHUNK_BITS = 10, RGI_CHUNK = 1 << RGI_CHUNK_BITS };

/** No record. */
#define RGI_NONE UINT32_MAX

typedef struct rgi_slots {
    rgi_chunks chunks;
    uint32_t record_size; /* bytes */
    uint32_t used;        /* records that were ever taken: all indices are below */
    uint32_t free_first;  /* head of the list of the free */
    uint32_t free_count;
    const char *purpose; /* for messages */
} rgi_slots;

void rgi_slots_init(rgi_slots *slots, rgi_memory *memory, size_t record_size, const char *purpose);
void rgi_slots_free(rgi_slots *slots);

/**
 * Makes sure that the next `count` calls of rgi_slots_take succeed. RG_OUT_OF_MEMORY, RG_LIMIT_EXCEEDED (2^32 - 1
 * records); what is taken is not touched. Cost: constant for count <= 1024, but for the chunk pointers, 8 bytes for
 * 1024 records.
 */
rg_result rgi_slots_reserve(rgi_slots *slots, uint64_t count);

static inline void *rgi_slots_at(const rgi_slots *slots, uint32_t index) {
    return slots->chunks.at[index >> RGI_CHUNK_BITS] + (size_t)(index & (RGI_CHUNK - 1)) * slots->record_size;
}

/** The index that rgi_slots_take would return next. */
static inline uint32_t rgi_slots_next(const rgi_slots *slots) {
    return slots->free_count ? slots->free_first : slots->used;
}

/** For records that are addressed, not taken: makes sure that there is one of this index. RG_OUT_OF_MEMORY. */
rg_result rgi_slots_cover(rgi_slots *slots, uint32_t index);

/** The record behind one of the free in the order in which they will be taken. */
static inline uint32_t rgi_slots_after(const rgi_slots *slots, uint32_t index) {
    uint32_t next;
    memcpy(&next, rgi_slots_at(slots, index), sizeof next);
    return next;
}

/** Takes a record: the one freed last, else a new one, which is all zeros. Must have been reserved. */
uint32_t rgi_slots_take(rgi_slots *slots);

/** Takes back that the last record was ever taken, if it is the one given back last. */
void rgi_slots_trim(rgi_slots *slots);

/** Gives a record back. Its first four bytes are the list's from now on; the rest stays as it is. */
void rgi_slots_give(rgi_slots *slots, uint32_t index);

#endif
