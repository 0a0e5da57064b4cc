/* SPDX-License-Identifier: MIT */
#include "slots.h"

#include "error.h"

#include <inttypes.h>
#include <string.h>

void rgi_slots_init(rgi_slots *slots, rgi_memory *memory, size_t record_size, const char *purpose) {
    memset(slots, 0, sizeof *slots);
    slots->memory = memory;
    slots->record_size = (uint32_t)record_size;
    slots->free_first = RGI_NONE;
    slots->purpose = purpose;
}

static size_t chunk_bytes(const rgi_slots *slots) {
    return (size_t)RGI_CHUNK * slots->record_size + RGI_SLACK;
}

void rgi_slots_free(rgi_slots *slots) {
    for (uint32_t i = 0; i < slots->chunk_count; i++)
        rgi_release(slots->memory, slots->chunks[i], 1, chunk_bytes(slots));
    rgi_release(slots->memory, slots->chunks, slots->chunk_room, sizeof *slots->chunks);
    rgi_slots_init(slots, slots->memory, slots->record_size, slots->purpose);
}

static rg_result make_room_for_pointers(rgi_slots *slots, uint32_t chunk_count) {
    if (chunk_count <= slots->chunk_room) return RG_OK;
    uint32_t room = slots->chunk_room ? slots->chunk_room * 2 : 4;
    if (room < chunk_count) room = chunk_count;
    char **chunks;
    rg_result result = rgi_allocate(slots->memory, room, sizeof *chunks, slots->purpose, &chunks);
    if (result) return result;
    if (slots->chunk_count) memcpy(chunks, slots->chunks, slots->chunk_count * sizeof *chunks);
    rgi_release(slots->memory, slots->chunks, slots->chunk_room, sizeof *chunks);
    slots->chunks = chunks;
    slots->chunk_room = room;
    return RG_OK;
}

rg_result rgi_slots_reserve(rgi_slots *slots, uint64_t count) {
    if (count <= slots->free_count) return RG_OK;
    uint64_t needed = slots->used + (count - slots->free_count);
    if (needed >= RGI_NONE)
        return rgi_fail(RG_LIMIT_EXCEEDED, "%" PRIu64 " %s are more than the %u that can be addressed", needed,
                        slots->purpose, RGI_NONE - 1);
    uint32_t chunk_count = (uint32_t)((needed + RGI_CHUNK - 1) >> RGI_CHUNK_BITS);
    rg_result result = make_room_for_pointers(slots, chunk_count);
    while (!result && slots->chunk_count < chunk_count) {
        result =
            rgi_allocate(slots->memory, 1, chunk_bytes(slots), slots->purpose, &slots->chunks[slots->chunk_count]);
        if (!result) slots->chunk_count++;
    }
    return result;
}

uint32_t rgi_slots_take(rgi_slots *slots) {
    if (slots->free_count) {
        uint32_t index = slots->free_first;
        memcpy(&slots->free_first, rgi_slots_at(slots, index), sizeof slots->free_first);
        slots->free_count--;
        return index;
    }
    uint32_t index = slots->used++;
    memset(rgi_slots_at(slots, index), 0, slots->record_size);
    return index;
}

void rgi_slots_give(rgi_slots *slots, uint32_t index) {
    memcpy(rgi_slots_at(slots, index), &slots->free_first, sizeof slots->free_first);
    slots->free_first = index;
    slots->free_count++;
}
