/* SPDX-License-Identifier: MIT */
#include "slots.h"

#include "error.h"

#include <inttypes.h>
#include <string.h>

void rgi_slots_init(rgi_slots *slots, rgi_memory *memory, size_t record_size, const char *purpose) {
    memset(slots, 0, sizeof *slots);
    rgi_chunks_init(&slots->chunks, memory, (uint32_t)(RGI_CHUNK * record_size));
    slots->record_size = (uint32_t)record_size;
    slots->free_first = RGI_NONE;
    slots->purpose = purpose;
}

void rgi_slots_free(rgi_slots *slots) {
    rgi_chunks_free(&slots->chunks);
    rgi_slots_init(slots, slots->chunks.memory, slots->record_size, slots->purpose);
}

rg_result rgi_slots_reserve(rgi_slots *slots, uint64_t count) {
    if (count <= slots->free_count) return RG_OK;
    uint64_t needed = slots->used + (count - slots->free_count);
    if (needed >= RGI_NONE)
        return rgi_fail(RG_LIMIT_EXCEEDED, "%" PRIu64 " %s are more than the %u that can be addressed", needed,
                        slots->purpose, RGI_NONE - 1);
    uint32_t chunk_count = (uint32_t)((needed + RGI_CHUNK - 1) >> RGI_CHUNK_BITS);
    rg_result result = RG_OK;
    slots->chunks.bulk = count > RGI_CHUNK;
    while (!result && slots->chunks.count < chunk_count) result = rgi_chunks_add(&slots->chunks, slots->purpose);
    return result;
}

rg_result rgi_slots_cover(rgi_slots *slots, uint32_t index) {
    rg_result result = RG_OK;
    while (!result && slots->chunks.count <= index >> RGI_CHUNK_BITS)
        result = rgi_chunks_add(&slots->chunks, slots->purpose);
    return result;
}

uint32_t rgi_slots_take(rgi_slots *slots) {
    if (slots->free_count) {
        uint32_t index = slots->free_first;
        slots->free_first = rgi_slots_after(slots, index);
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

void rgi_slots_trim(rgi_slots *slots) {
    if (slots->free_count == 0 || slots->free_first != slots->used - 1) return;
    slots->free_first = rgi_slots_after(slots, slots->free_first);
    slots->free_count--;
    slots->used--;
}
