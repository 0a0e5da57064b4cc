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

/* Large blocks are put on huge pages where the system has them to give: a wish, whose failure changes nothing. */
static void *default_allocate(void *user, size_t size, size_t alignment) {
    void *block;
    bool large = size >= RGI_HUGE_PAGE;
    (void)user;
    if (posix_memalign(&block, large ? RGI_HUGE_PAGE : alignment, size) != 0) return NULL;
#ifdef MADV_HUGEPAGE
    if (large) (void)madvise(block, size, MADV_HUGEPAGE);
#endif
    return block;
}

static void default_release(void *user, void *block, size_t size, size_t alignment) {
    (void)user, (void)size, (void)alignment;
    free(block);
}

rg_result rgi_memory_init(rgi_memory *memory, const rg_allocator *allocator) {
    memset(memory, 0, sizeof *memory);
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

rg_result rgi_allocate(rgi_memory *memory, uint64_t count, size_t size, const char *purpose, void *out) {
    void *block = NULL;
    if (count <= SIZE_MAX / 2 / size)
        block = memory->allocator.allocate(memory->allocator.user, (size_t)count * size, ALIGNMENT);
    if (!block)
        return rgi_fail(RG_OUT_OF_MEMORY, "no memory for %s: %" PRIu64 " times %zu bytes", purpose, count, size);
    __atomic_fetch_add(&memory->bytes, count * size, __ATOMIC_RELAXED);
    memcpy(out, &block, sizeof block);
    return RG_OK;
}

void rgi_release(rgi_memory *memory, void *block, uint64_t count, size_t size) {
    if (!block) return;
    __atomic_fetch_sub(&memory->bytes, count * size, __ATOMIC_RELAXED);
    memory->allocator.release(memory->allocator.user, block, (size_t)count * size, ALIGNMENT);
}
