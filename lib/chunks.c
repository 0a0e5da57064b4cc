/* SPDX-License-Identifier: MIT */
#include "chunks.h"

#include <string.h>

void rgi_chunks_init(rgi_chunks *chunks, rgi_memory *memory, uint32_t bytes) {
    memset(chunks, 0, sizeof *chunks);
    chunks->memory = memory;
    chunks->bytes = bytes;
}

/* Huge pages of the slab that begins with chunk `first`: an eighth of what there is already, so that little of them
 * is empty; none as long as that is not a whole one. */
static uint32_t slab_pages(const rgi_chunks *chunks, uint32_t first) {
    uint64_t filled = (uint64_t)first * chunks->bytes / RGI_HUGE_PAGE;
    return filled < 32 ? (uint32_t)(filled / 8) : 4;
}

static size_t slab_bytes(const rgi_chunks *chunks, uint32_t first) {
    uint32_t pages = slab_pages(chunks, first);
    return pages ? (size_t)pages * RGI_HUGE_PAGE : (size_t)chunks->bytes + RGI_SLACK;
}

static uint32_t slab_length(const rgi_chunks *chunks, uint32_t first) {
    return (uint32_t)((slab_bytes(chunks, first) - RGI_SLACK) / chunks->bytes);
}

bool rgi_chunks_free_some(rgi_chunks *chunks, uint32_t blocks) {
    for (; blocks && chunks->freed < chunks->count; blocks--) {
        uint32_t first = chunks->freed;
        rgi_release(chunks->memory, chunks->at[first], 1, slab_bytes(chunks, first));
        chunks->freed += slab_length(chunks, first);
    }
    return chunks->freed < chunks->count;
}

void rgi_chunks_free(rgi_chunks *chunks) {
    (void)rgi_chunks_free_some(chunks, UINT32_MAX);
    rgi_release(chunks->memory, chunks->at, chunks->room, sizeof *chunks->at);
    rgi_chunks_init(chunks, chunks->memory, chunks->bytes);
}

static rg_result make_room_for_pointer(rgi_chunks *chunks, const char *purpose) {
    if (chunks->count < chunks->room) return RG_OK;
    uint32_t room = chunks->room ? chunks->room * 2 : 4;
    char **at;
    rg_result result = rgi_allocate(chunks->memory, room, sizeof *at, purpose, &at);
    if (result) return result;
    if (chunks->count) memcpy(at, chunks->at, chunks->count * sizeof *at);
    char **old = chunks->at;
    uint32_t old_room = chunks->room;
    chunks->at = at;
    chunks->room = room;
    rgi_release(chunks->memory, old, old_room, sizeof *old);
    return RG_OK;
}

rg_result rgi_chunks_add(rgi_chunks *chunks, const char *purpose) {
    uint32_t number = chunks->count;
    rg_result result = make_room_for_pointer(chunks, purpose);
    if (result) return result;
    if (number > 0 && number < chunks->slab + slab_length(chunks, chunks->slab)) {
        chunks->at[number] = chunks->at[chunks->slab] + (size_t)(number - chunks->slab) * chunks->bytes;
    } else {
        result = rgi_allocate(chunks->memory, 1, slab_bytes(chunks, number), purpose, &chunks->at[number]);
        if (result) return result;
        if (chunks->bulk) rgi_wish_huge_pages(chunks->memory, chunks->at[number], slab_bytes(chunks, number));
        chunks->slab = number;
    }
    chunks->count++;
    return RG_OK;
}
