/* SPDX-License-Identifier: MIT */
#include "allocator.h"

#include <stdio.h>
#include <stdlib.h>

/* Lies right before each block; its own size keeps the largest alignment that may be asked for. */
typedef union tag {
    struct {
        uint64_t magic;
        size_t size, alignment;
        void *raw;
    } fields;
    char room[64];
} tag;

static const uint64_t LIVE = UINT64_C(0x6C697665626C6F63), DEAD = UINT64_C(0x6465616462726963);

static void give_up(const char *why) {
    fprintf(stderr, "FAILED: allocator: %s\n", why);
    abort();
}

static bool must_fail(test_allocator *books) {
    books->calls++;
    if (books->fail_at == 0 || books->calls < books->fail_at) return false;
    return books->calls == books->fail_at || books->fail_ever_after;
}

static void *allocate(void *user, size_t size, size_t alignment) {
    test_allocator *books = user;
    if (size == 0) give_up("a size of 0");
    if (alignment == 0 || alignment > 64 || (alignment & (alignment - 1)) != 0) give_up("not an alignment");
    if (must_fail(books)) {
        books->failed++;
        return NULL;
    }
    char *raw = size <= SIZE_MAX / 2 ? malloc(size + 3 * sizeof(tag)) : NULL;
    if (!raw) return NULL;
    /* Aligned to what was asked for and to no more, so that code that counts on more is found out; but to 8 at least,
     * for the tag's sake. */
    uintptr_t start = (uintptr_t)raw, at = (start + sizeof(tag) + 63) & ~(uintptr_t)63;
    if (alignment < 64) at += alignment < 8 ? 8 : alignment;
    tag *t = (tag *)(void *)(raw + (at - start) - sizeof(tag));
    t->fields.magic = LIVE;
    t->fields.size = size;
    t->fields.alignment = alignment;
    t->fields.raw = raw;
    books->live_blocks++;
    books->live_bytes += size;
    return t + 1;
}

static void release(void *user, void *memory, size_t size, size_t alignment) {
    test_allocator *books = user;
    tag *t = (tag *)memory - 1;
    if (!memory) give_up("NULL was released");
    if (t->fields.magic == DEAD) give_up("released twice");
    if (t->fields.magic != LIVE) give_up("released what was never given out");
    if (t->fields.size != size) give_up("released with another size");
    if (t->fields.alignment != alignment) give_up("released with another alignment");
    t->fields.magic = DEAD;
    books->live_blocks--;
    books->live_bytes -= size;
    free(t->fields.raw);
}

rg_allocator test_allocator_hooks(test_allocator *books) {
    return (rg_allocator){books, allocate, release};
}
