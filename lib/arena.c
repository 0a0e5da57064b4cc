/* SPDX-License-Identifier: MIT */
#include "lattice.h"

#include "error.h"

#include <string.h>

enum { CHUNK = RGI_LINE << RGI_LINE_BITS };

/* Lines that a record takes. Kernels load 16 lanes wherever a block has 4 or 8: what they read beyond its end is the
 * next record, or the slack behind a chunk. */
static uint32_t lines_of(uint32_t kind) {
    static const uint8_t lines[RGI_KINDS] = {[RGI_NODES] = 4, [4] = 2, [8] = 3, [16] = 6, [5] = 3, [9] = 4, [17] = 8};
    return lines[kind];
}

void rgi_arena_init(rgi_arena *arena, rgi_memory *memory) {
    memset(arena, 0, sizeof *arena);
    rgi_chunks_init(&arena->chunks, memory, CHUNK);
}

void rgi_arena_free(rgi_arena *arena) {
    rgi_chunks_free(&arena->chunks);
}

rg_result rgi_arena_reserve(rgi_arena *arena, uint32_t kind, uint32_t count) {
    while (arena->kinds[kind].count < count) {
        uint32_t number = arena->chunks.count, lines = lines_of(kind);
        if (number >> RGI_CHUNK_NUMBER_BITS)
            return rgi_fail(RG_LIMIT_EXCEEDED, "a grid has %u chunks and can address no more", number);
        rg_result result = rgi_chunks_add(&arena->chunks, "the nodes and blocks of a grid");
        if (result) return result;
        /* Given back from the last to the first, so that they are taken in the order of their addresses. */
        uint32_t records = (1u << RGI_LINE_BITS) / lines;
        uint32_t first = number == 0 && kind == RGI_NODES; /* reference 0 is none */
        arena->kinds[kind].used += records - first;
        while (records-- > first)
            rgi_arena_give(arena, kind, (kind ? 1u << 31 : 0) | number << RGI_LINE_BITS | records * lines);
    }
    return RG_OK;
}

rgi_ref rgi_arena_take(rgi_arena *arena, uint32_t kind) {
    rgi_ref ref = arena->kinds[kind].first;
    memcpy(&arena->kinds[kind].first, rgi_arena_at(arena, ref), sizeof ref);
    arena->kinds[kind].count--;
    arena->kinds[kind].used++;
    return ref;
}

void rgi_arena_give(rgi_arena *arena, uint32_t kind, rgi_ref ref) {
    memcpy(rgi_arena_at(arena, ref), &arena->kinds[kind].first, sizeof ref);
    arena->kinds[kind].first = ref;
    arena->kinds[kind].count++;
    arena->kinds[kind].used--;
}
