/* SPDX-License-Identifier: MIT */
/*
 * endings: a scene may be destroyed at any time: right after it was made, with objects in it, while its grid is being
 * rebuilt, after calls that failed, and while other threads trace long batches, which then end as if nothing were.
 * Nothing is left of it.
 */
#define _POSIX_C_SOURCE 200809L
#include "field.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ------------------------------------------------------------------------------------ while others trace */

enum { TRACERS = 3, BATCHES = 4 /* fields of rays a call */ };

/* A shape that tells of rays that come to it: each tracer's first, a quarter of a unit beside the other tracers'. */
struct gate {
    uint32_t begun; /* atomic: bits of tracers whose call is under way */
};

static const double BESIDE = 0.25;

struct tracer {
    struct field *field;
    rg_ray *rays;
    rg_hit *hits;
    rg_result result;
    rg_scene *scene;
};

static int32_t pass_gate(void *user, const rg_local_ray *ray, rg_local_hit *hit) {
    struct gate *gate = user;
    (void)hit;
    __atomic_fetch_or(&gate->begun, 1u << lround(ray->origin[1] / BESIDE), __ATOMIC_SEQ_CST);
    return 0;
}

static void *trace_batch(void *argument) {
    struct tracer *tracer = argument;
    tracer->result = rg_scene_trace(tracer->scene, tracer->rays, tracer->hits, BATCHES * FIELD);
    return NULL;
}

/* Only the first ray of each call goes through it, unhindered. */
static void put_up_gate(struct field *field, struct gate *gate) {
    const rg_user_shape definition = {
        .size = sizeof definition, .user = gate, .lo = {-1, -1, -1}, .hi = {1, 1, 1}, .intersect = pass_gate};
    rg_shape *shape = NULL;
    const rg_pose pose = rg_pose_at(0, 0, -1000);
    MUST(rg_shape_create_user(NULL, &definition, &shape));
    MUST(rg_scene_insert(field->scene, shape, &pose, NULL));
    rg_shape_release(&shape);
}

static void tracer_begin(struct tracer *tracer, struct field *field, int number) {
    const double origin[3] = {-10, BESIDE * number, -1000}, direction[3] = {1, 0, 0};
    tracer->field = field;
    tracer->scene = field->scene;
    tracer->rays = calloc(BATCHES * FIELD, sizeof *tracer->rays);
    tracer->hits = calloc(BATCHES * FIELD, sizeof *tracer->hits);
    demand(tracer->rays && tracer->hits, "memory");
    for (int b = 0; b < BATCHES; b++) field_rays(field, tracer->rays + b * FIELD);
    /* In place of the first. */
    tracer->rays[0] = rg_ray_from(origin, direction);
}

static void tracer_end(struct tracer *tracer) {
    demand(tracer->result == RG_OK, "a trace that began before the end of its scene succeeds");
    demand(tracer->hits[0].object == RG_NO_OBJECT, "nothing is hit where nothing is");
    for (int b = 1; b < BATCHES; b++)
        demand(field_is_right(tracer->field, tracer->hits + b * FIELD), "and its hits are right");
    free(tracer->rays);
    free(tracer->hits);
}

static void destroy_while_traced(rg_grid_kind kind, uint32_t workers, bool rebuilding) {
    static struct field field;
    struct gate gate = {0};
    struct tracer tracers[TRACERS];
    pthread_t threads[TRACERS];
    field_begin(&field, kind, workers);
    if (rebuilding) field_move_until_rebuilding(&field);
    put_up_gate(&field, &gate); /* now: a grid is not rebuilt because of most objects alone */
    for (int i = 0; i < TRACERS; i++) {
        tracer_begin(&tracers[i], &field, i);
        demand(pthread_create(&threads[i], NULL, trace_batch, &tracers[i]) == 0, "pthread_create");
    }
    while (__atomic_load_n(&gate.begun, __ATOMIC_SEQ_CST) != (1u << TRACERS) - 1) continue;
    /* No call begins from here on. */
    field_end(&field);
    for (int i = 0; i < TRACERS; i++) {
        pthread_join(threads[i], NULL);
        tracer_end(&tracers[i]);
    }
}

/* --------------------------------------------------------------------------------------------------- early */

static void destroy_fresh(rg_grid_kind kind, uint32_t workers) {
    struct books books = {0};
    rg_scene *scene = create_scene(&books, kind, workers);
    destroy_scene(&books, &scene);
    MUST(rg_scene_destroy(&scene)); /* a pointer to NULL */
    MUST(rg_scene_destroy(NULL));
}

static void destroy_full(rg_grid_kind kind, uint32_t workers) {
    static struct field field;
    field_begin(&field, kind, workers);
    field_end(&field);
}

static void destroy_while_rebuilding(rg_grid_kind kind, uint32_t workers) {
    static struct field field;
    field_begin(&field, kind, workers);
    field_move_until_rebuilding(&field);
    field_end(&field);
}

/* Each kind of call, refused. */
static void fail(struct field *field) {
    const double nowhere[3] = {0, 0, NAN};
    const rg_pose bad = {.position = {0, 0, 0}};
    rg_pose_views poses = {.size = sizeof poses};
    rg_insert_views views = {.size = sizeof views, .poses = &poses, .shapes = &field->ball};
    rg_grid_config grid = {.size = sizeof grid, .kind = 17};
    rg_object object = 12345;
    demand(rg_scene_insert(field->scene, field->ball, &bad, &object) == RG_INVALID_VALUE, "a singular pose");
    demand(rg_scene_insert(field->scene, NULL, NULL, &object) == RG_INVALID_ARGUMENT, "no shape");
    demand(rg_scene_insert_many(field->scene, &views, 5, NULL) == RG_INVALID_ARGUMENT, "no positions");
    demand(rg_scene_move_to(field->scene, field->objects[0], nowhere) == RG_INVALID_VALUE, "a position of NaN");
    demand(rg_scene_remove(field->scene, object) == RG_INVALID_ID, "an id that was never given");
    demand(rg_grid_configure(field->scene, RG_GRID_OF_SCENE, &grid) != RG_OK, "a kind of grid that is none");
    demand(rg_grid_destroy(field->scene, RG_GRID_OF_SCENE) == RG_BUSY, "the scene's own grid");
}

static void destroy_after_failures(rg_grid_kind kind, uint32_t workers) {
    static struct field field;
    rg_result result = RG_OK;
    field_begin(&field, kind, workers);
    fail(&field);
    /* And those for which there is no memory: as many inserts as there is room for. */
    __atomic_store_n(&field.books.blocks_left, 0, __ATOMIC_SEQ_CST);
    for (int i = 0; i < 100 * FIELD && !result; i++) {
        const rg_pose pose = rg_pose_at(i, -100, i % 7);
        result = rg_scene_insert(field.scene, field.ball, &pose, NULL);
    }
    demand(result == RG_OUT_OF_MEMORY, "without memory an insert fails at last");
    demand(rg_grid_rebuild(field.scene, RG_GRID_OF_SCENE) == RG_OUT_OF_MEMORY, "and so does a rebuild");
    field_check(&field);
    field_end(&field);
}

/* Each block that making a scene takes is refused in turn. */
static void fail_to_create(rg_grid_kind kind, uint32_t workers) {
    const rg_grid_config grid = {.size = sizeof grid, .kind = kind};
    rg_result result = RG_OUT_OF_MEMORY;
    for (int64_t blocks = 0; result == RG_OUT_OF_MEMORY; blocks++) {
        struct books books = {0};
        rg_scene *scene = NULL;
        const rg_scene_config config = {
            .size = sizeof config, .workers = workers, .grid = &grid, .allocator = books_hooks(&books)};
        books.blocks_left = blocks;
        result = rg_scene_create(&config, &scene);
        demand(result == RG_OK || (result == RG_OUT_OF_MEMORY && !scene), "it is made, or there is no memory for it");
        if (scene) MUST(rg_scene_destroy(&scene));
        demand(books.bytes == 0, "nothing is left of it");
    }
}

/* A scene outlives its frames. */
static void destroy_with_frame(rg_grid_kind kind, uint32_t workers) {
    static struct field field;
    rg_scene *frame = NULL, *scene;
    field_begin(&field, kind, workers);
    scene = field.scene;
    MUST(rg_scene_create_frame(scene, NULL, &frame));
    field_move(&field, 500);
    demand(rg_scene_destroy(&scene) == RG_BUSY && scene == field.scene, "a scene with a frame can't be destroyed");
    MUST(rg_scene_update_frame(frame));
    MUST(rg_scene_destroy(&frame));
    field_check(&field);
    field_end(&field);
}

/* ----------------------------------------------------------------------------------- from inside a callback */

static int32_t destroy_from_inside(void *user, const rg_local_ray *ray, rg_local_hit *hit) {
    rg_scene **scene = user;
    rg_scene *mine = *scene;
    (void)ray, (void)hit;
    demand(rg_scene_destroy(&mine) == RG_BUSY && mine == *scene, "a callback can't destroy the scene that it is in");
    return 0;
}

static void end_shape(void *user) {
    rg_scene **scene = user;
    *scene = NULL;
}

static void destroy_inside(rg_grid_kind kind, uint32_t workers) {
    struct books books = {0};
    rg_scene *scene = create_scene(&books, kind, workers), *seen = scene;
    const rg_user_shape definition = {.size = sizeof definition,
                                      .user = &seen,
                                      .lo = {-1, -1, -1},
                                      .hi = {1, 1, 1},
                                      .intersect = destroy_from_inside,
                                      .destroy = end_shape};
    rg_shape *shape = NULL;
    const rg_ray ray = rg_ray_from((double[3]){-5, 0, 0}, (double[3]){1, 0, 0});
    rg_hit hit;
    MUST(rg_shape_create_user(NULL, &definition, &shape));
    MUST(rg_scene_insert(scene, shape, NULL, NULL));
    rg_shape_release(&shape);
    MUST(rg_scene_trace(scene, &ray, &hit, 1));
    demand(seen == scene, "a shape lives as long as an object has it");
    destroy_scene(&books, &scene);
    demand(seen == NULL, "and ends with the scene");
}

int main(void) {
    for (int k = 0; k < 3; k++) {
        for (uint32_t workers = 1; workers <= 4; workers *= 2) {
            destroy_fresh(KINDS[k], workers);
            destroy_full(KINDS[k], workers);
            destroy_while_rebuilding(KINDS[k], workers);
            destroy_after_failures(KINDS[k], workers);
            fail_to_create(KINDS[k], workers);
            destroy_with_frame(KINDS[k], workers);
            destroy_inside(KINDS[k], workers);
            destroy_while_traced(KINDS[k], workers, false);
            destroy_while_traced(KINDS[k], workers, true);
        }
    }
    return EXIT_SUCCESS;
}
