/* SPDX-License-Identifier: MIT */
/*
 * allocator.h: an allocator that keeps books and can be told to fail. It ends the process when memory comes back with
 * another size or alignment than it was given out with, twice, or from elsewhere.
 */
#ifndef RAYGRID_TESTS_ALLOCATOR_H
#define RAYGRID_TESTS_ALLOCATOR_H

#include <raygrid/raygrid.h>
#include <stdbool.h>

typedef struct test_allocator {
    uint64_t calls;       /* of allocate, those that failed among them */
    uint64_t fail_at;     /* the number, from 1, of the call that fails; 0: none */
    bool fail_ever_after; /* and all that follow */
    uint64_t failed, live_blocks, live_bytes;
} test_allocator;

/** The hooks for the library. Not for use by several threads at once. */
rg_allocator test_allocator_hooks(test_allocator *books);

#endif
