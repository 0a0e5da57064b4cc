/* SPDX-License-Identifier: MIT */
/*
 * threads: the system refuses the N-th thread of a scene, or of the making of a mesh. Linked to the archive with
 * pthread_create and pthread_join wrapped: the call returns RG_OUT_OF_THREADS, the threads that did start have ended,
 * and no memory is left.
 */
#include "allocator.h"

#include <errno.h>
#include <inttypes.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>

static int created, joined, fail_at;

typedef void *start_function(void *);

/* The linker's names: __real_ is the system's, __wrap_ is what the library calls in its place. */
int __real_pthread_create(pthread_t *thread, const pthread_attr_t *how, start_function *start, void *argument);
int __real_pthread_join(pthread_t thread, void **result);
int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *how, start_function *start, void *argument);
int __wrap_pthread_join(pthread_t thread, void **result);

int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *how, start_function *start, void *argument) {
    if (created + 1 == fail_at) return EAGAIN;
    int result = __real_pthread_create(thread, how, start, argument);
    if (result == 0) created++;
    return result;
}

int __wrap_pthread_join(pthread_t thread, void **result) {
    joined++;
    return __real_pthread_join(thread, result);
}

static void demand(bool holds, const char *what, int turn) {
    if (holds) return;
    fprintf(stderr, "FAILED: thread %d: %s; message: %s\n", turn, what, rg_error_message());
    exit(EXIT_FAILURE);
}

static rg_result create(test_allocator *memory, uint32_t workers, rg_scene **scene) {
    rg_scene_config config = {.size = sizeof config, .workers = workers, .allocator = test_allocator_hooks(memory)};
    created = joined = 0;
    return rg_scene_create(&config, scene);
}

static void refuse(uint32_t workers, int n) {
    test_allocator memory = {0};
    rg_scene *const untouched = (rg_scene *)(void *)&memory;
    rg_scene *scene = untouched;
    fail_at = n;
    rg_result result = create(&memory, workers, &scene);
    demand(result == RG_OUT_OF_THREADS, "rg_scene_create did not return RG_OUT_OF_THREADS", n);
    demand(rg_error_message()[0] != 0, "no message", n);
    demand(scene == untouched, "an output was written", n);
    demand(created == n - 1, "it went on after a thread was refused", n);
    demand(joined == created, "not all threads that started were waited for", n);
    demand(memory.live_blocks == 0, "memory is left", n);
}

static void allow(uint32_t workers) {
    test_allocator memory = {0};
    rg_scene *scene = NULL;
    fail_at = 0;
    demand(create(&memory, workers, &scene) == RG_OK, "rg_scene_create", 0);
    demand(created == (int)workers - 1, "as many threads as workers, less the caller", 0);
    demand(rg_scene_destroy(&scene) == RG_OK, "rg_scene_destroy", 0);
    demand(joined == created, "not all threads were waited for", 0);
    demand(memory.live_blocks == 0, "memory is left", 0);
}

static rg_result create_mesh(test_allocator *memory, uint32_t workers, rg_shape **shape) {
    static const float CORNERS[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    rg_shape_config config = {.size = sizeof config, .workers = workers, .allocator = test_allocator_hooks(memory)};
    rg_mesh_views views = {.size = sizeof views, .vertex_count = 3, .triangle_count = 1};
    views.vertices = rg_input3_packed(CORNERS, sizeof *CORNERS, RG_F32);
    created = joined = 0;
    return rg_shape_create_mesh(&config, &views, shape);
}

/* n 0: none is refused; else the n-th. */
static void make_mesh(uint32_t workers, int n) {
    test_allocator memory = {0};
    rg_shape *shape = NULL;
    fail_at = n;
    rg_result result = create_mesh(&memory, workers, &shape);
    demand(result == (n ? RG_OUT_OF_THREADS : RG_OK), "rg_shape_create_mesh", n);
    demand(created == (n ? n : (int)workers) - 1, "threads of a mesh", n);
    demand(joined == created, "not all threads of a mesh were waited for", n);
    demand((shape != NULL) == (n == 0), "a mesh", n);
    rg_shape_release(&shape);
    demand(memory.live_blocks == 0, "memory is left", n);
}

int main(void) {
    for (int n = 1; n <= 7; n++) refuse(8, n);
    refuse(2, 1);
    allow(1);
    allow(2);
    allow(8);
    for (int n = 0; n <= 2; n++) make_mesh(3, n);
    make_mesh(1, 0);
    return EXIT_SUCCESS;
}
