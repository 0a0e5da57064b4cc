/* SPDX-License-Identifier: MIT */
/* The state of a scene, written. */
#include "any_grid.h"
#include "error.h"
#include "snapshot.h"

#include <inttypes.h>

/* Slots of one record. */
enum { BATCH = 1024 };

static void write_grids(const rg_scene *scene, rgi_writer *w) {
    for (uint32_t i = 0; i < scene->grid_places; i++) {
        const rgi_grid_place *place = &scene->grids[i];
        rgi_put_head(w, RGI_RECORD_GRID, 1 + (place->grid ? RGI_CONFIG_WORDS : 0));
        rgi_put_pair(w, place->generation, place->grid != NULL);
        if (place->grid) rgi_put_config(w, &place->grid->config);
        rgi_put_end(w);
    }
}

static rg_result write_shapes(const rg_scene *scene, rgi_writer *w, rgi_shape_numbers *numbers) {
    const rg_shape *last = NULL;
    for (uint32_t slot = 0; slot < scene->objects.used; slot++) {
        const rgi_object *object = rgi_scene_object(scene, slot);
        uint32_t number;
        if (!object->shape || object->shape == last) continue;
        last = object->shape;
        rg_result result = rgi_write_shape(w, numbers, object->shape, &number);
        if (!result) continue;
        rgi_fail_prefix("object 0x%" PRIx64 ": ", rgi_object_id(object, slot));
        return result;
    }
    return RG_OK;
}

/* A slot as it is to be written. */
typedef struct slot_state {
    uint32_t flags;
    const float *linear;
    double scale;
} slot_state;

static uint64_t look_at_slot(const rg_scene *scene, const rgi_object *object, slot_state *state) {
    state->flags = 0;
    if (!object->shape) return 1;
    const rgi_linear *linear = rgi_scene_linear(scene, object);
    state->linear = linear ? linear->matrix : rgi_identity;
    state->scale = rgi_object_scale(object, linear);
    state->flags = RGI_IS_LIVE | rgi_pose_flags(state->linear, state->scale);
    return 2 + rgi_pose_words(state->flags);
}

static void write_slots(const rg_scene *scene, rgi_writer *w, const rgi_shape_numbers *numbers) {
    for (uint32_t first = 0, end; first < scene->objects.used; first = end) {
        uint64_t words = 0;
        slot_state state;
        end = scene->objects.used - first > BATCH ? first + BATCH : scene->objects.used;
        for (uint32_t i = first; i < end; i++) words += look_at_slot(scene, rgi_scene_object(scene, i), &state);
        rgi_put_head(w, RGI_RECORD_SLOTS, words);
        for (uint32_t i = first; i < end; i++) {
            const rgi_object *object = rgi_scene_object(scene, i);
            uint32_t number = 0;
            (void)look_at_slot(scene, object, &state);
            rgi_put_pair(w, object->generation, state.flags | (object->shape ? object->grid << 8 : 0));
            if (!object->shape) continue;
            (void)rgi_shape_numbers_find(numbers, object->shape, &number);
            rgi_put_pair(w, number, object->mask);
            rgi_put_pose(w, state.flags, object->position, state.linear, state.scale);
        }
        rgi_put_end(w);
    }
}

/* Frames have no list: what of theirs is neither live nor retired, from the lowest slot up. */
static bool is_free(const rg_scene *scene, uint32_t slot) {
    const rgi_object *object = rgi_scene_object(scene, slot);
    return !object->shape && object->generation < UINT32_MAX;
}

static void write_free_of_frame(const rg_scene *frame, rgi_writer *w) {
    uint64_t count = 0;
    for (uint32_t slot = 0; slot < frame->objects.used; slot++) count += is_free(frame, slot);
    rgi_put_head(w, RGI_RECORD_FREE, count);
    for (uint32_t slot = 0; slot < frame->objects.used; slot++) {
        if (is_free(frame, slot)) rgi_put(w, slot);
    }
    rgi_put_end(w);
}

static void write_free(const rg_scene *scene, rgi_writer *w) {
    uint32_t slot = scene->objects.free_first;
    if (scene->follows) {
        write_free_of_frame(scene, w);
        return;
    }
    rgi_put_head(w, RGI_RECORD_FREE, scene->objects.free_count);
    for (uint32_t i = 0; i < scene->objects.free_count; i++) {
        rgi_put(w, slot);
        slot = rgi_slots_after(&scene->objects, slot);
    }
    rgi_put_end(w);
}

static void write_counts(const rg_scene *scene, rgi_writer *w, const rgi_shape_numbers *numbers) {
    rgi_put_head(w, RGI_RECORD_STATE, 4);
    rgi_put(w, scene->grid_places);
    rgi_put(w, numbers->count);
    rgi_put(w, scene->objects.used);
    rgi_put(w, scene->object_count);
    rgi_put_end(w);
}

rg_result rgi_snapshot_write(const rg_scene *scene, rgi_writer *w, rgi_shape_numbers *numbers) {
    write_grids(scene, w);
    rg_result result = write_shapes(scene, w, numbers);
    if (result) return result;
    write_slots(scene, w, numbers);
    write_free(scene, w);
    write_counts(scene, w, numbers);
    if (rgi_writer_flush(w)) return RG_OK;
    return rgi_fail(RG_CALLBACK_FAILED, "write returned %d after %" PRIu64 " bytes", (int)w->failed, w->bytes);
}

rg_result rg_scene_save(rg_scene *scene, const rg_sink *sink) {
    rgi_writer writer;
    rgi_shape_numbers numbers;
    rgi_frame frame;
    if (!scene) return rgi_fail(RG_INVALID_ARGUMENT, "scene is NULL");
    rg_result result = rgi_writer_begin(&writer, sink, RGI_SNAPSHOT);
    if (result) return result;
    rgi_shape_numbers_init(&numbers, &scene->memory);
    rgi_scene_begin_read(scene, &frame);
    result = rgi_snapshot_write(scene, &writer, &numbers);
    rgi_scene_end_read(scene, &frame);
    rgi_shape_numbers_free(&numbers);
    return result;
}
