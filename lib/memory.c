/* SPDX-License-Identifier: MIT */
#define _DEFAULT_SOURCE /* madvise */
#include "memory.h"

#include "error.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

/* A cache line: no two blocks share one, and any SIMD load is aligned. */
enum { ALIGNMENT = 64 };

static void *default_allocate(void *user, size_t size, size_t alignment) {
    void *block;
    (void)user;
    return posix_memalign(&block, size >= RGI_HUGE_PAGE ? RGI_HUGE_PAGE : alignment, size) ? NULL : block;
}

void rgi_wish_huge_pages(const rgi_memory *memory, void *block, size_t bytes) {
#ifdef MADV_HUGEPAGE
    if (memory->allocator.allocate == default_allocate && bytes >= RGI_HUGE_PAGE)
        (void)madvise(block, bytes, MADV_HUGEPAGE);
#else
    (void)memory, (void)block, (void)bytes;
#endif
}

static void default_release(void *user, void *block, size_t size, size_t alignment) {
    (void)user, (void)size, (void)alignment;
    free(block);
}

rg_result rgi_memory_init(rgi_memory *memory, const rg_allocator *allocator) {
    memset(memory, 0, sizeof *memory);
    memory->limit = UINT64_MAX;
    if (!allocator || (!allocator->allocate && !allocator->release)) {
        memory->allocator.allocate = default_allocate;
        memory->allocator.release = default_release;
        return RG_OK;
    }
    if (!allocator->allocate)
        return rgi_fail(RG_INVALID_ARGUMENT, "allocator.allocate is NULL, allocator.release is not");
    if (!allocator->release)
        return rgi_fail(RG_INVALID_ARGUMENT, "allocator.release is NULL, allocator.allocate is not");
    memory->allocator = *allocator;
    return RG_OK;
}

/* Counts bytes that are to be allocated. False, and nothing counted, beyond the limit. */
static bool count(rgi_memory *memory, uint64_t bytes) {
    uint64_t after = __atomic_add_fetch(&memory->bytes, bytes, __ATOMIC_RELAXED);
    if (after <= memory->limit) return true;
    __atomic_fetch_sub(&memory->bytes, bytes, __ATOMIC_RELAXED);
    return false;
}

rg_result rgi_allocate(rgi_memory *memory, uint64_t number, size_t size, const char *purpose, void *out) {
    void *block = NULL;
    uint64_t bytes = number * size;
    if (number > SIZE_MAX / 2 / size)
        return rgi_fail(RG_OUT_OF_MEMORY, "no memory for %s: %" PRIu64 " times %zu bytes", purpose, number, size);
    if (!count(memory, bytes))
        return rgi_fail(RG_OUT_OF_MEMORY, "%s would need %" PRIu64 " bytes more, beyond the limit of %" PRIu64,
                        purpose, bytes, memory->limit);
    block = memory->allocator.allocate(memory->allocator.user, (size_t)bytes, ALIGNMENT);
    if (!block) {
        __atomic_fetch_sub(&memory->bytes, bytes, __ATOMIC_RELAXED);
        return rgi_fail(RG_OUT_OF_MEMORY, "no memory for %s: %" PRIu64 " times %zu bytes", purpose, number, size);
    }
    memcpy(out, &block, sizeof block);
    return RG_OK;
}

void rgi_release(rgi_memory *memory, void *block, uint64_t count, size_t size) {
    if (!block) return;
    __atomic_fetch_sub(&memory->bytes, count * size, __ATOMIC_RELAXED);
    memory->allocator.release(memory->allocator.user, block, (size_t)count * size, ALIGNMENT);
}
