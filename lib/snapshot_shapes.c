/* SPDX-License-Identifier: MIT */
/* Shapes, poses and configurations as words: each written and read side by side. */
#include "snapshot.h"

#include "error.h"
#include "grid.h"
#include "pose.h"
#include "shape.h"

#include <inttypes.h>

/* ---------------------------------------------------------------------------------------------------- poses */

uint32_t rgi_pose_flags(const float linear[9], double scale) {
    const double one = 1;
    uint32_t flags = memcmp(linear, rgi_identity, sizeof rgi_identity) != 0 ? RGI_HAS_LINEAR : 0;
    return flags | (memcmp(&scale, &one, sizeof one) != 0 ? RGI_HAS_SCALE : 0);
}

void rgi_put_pose(rgi_writer *w, uint32_t flags, const double position[3], const float linear[9], double scale) {
    rgi_put_doubles(w, position, 3);
    if (flags & RGI_HAS_LINEAR) {
        uint64_t words[RGI_LINEAR_WORDS] = {0};
        memcpy(words, linear, 9 * sizeof *linear);
        for (int i = 0; i < RGI_LINEAR_WORDS; i++) rgi_put(w, words[i]);
    }
    if (flags & RGI_HAS_SCALE) rgi_put_doubles(w, &scale, 1);
}

void rgi_get_pose(const rgi_stream_record *record, uint64_t i, uint64_t flags, rg_pose *pose) {
    *pose = rg_pose_at(0, 0, 0);
    rgi_get_doubles(record, i, pose->position, 3);
    i += RGI_POSITION_WORDS;
    if (flags & RGI_HAS_LINEAR) {
        memcpy(pose->linear, record->words + i * RGI_WORD, sizeof pose->linear);
        i += RGI_LINEAR_WORDS;
    }
    if (flags & RGI_HAS_SCALE) rgi_get_doubles(record, i, &pose->scale, 1);
}

/* --------------------------------------------------------------------------------------------------- grids */

void rgi_put_config(rgi_writer *w, const rg_grid_config *config) {
    rgi_put_pair(w, (uint32_t)config->kind, config->resolution);
    rgi_put_doubles(w, config->lo, 3);
    rgi_put_doubles(w, config->hi, 3);
    rgi_put_doubles(w, &config->rebuild_factor, 1);
}

rg_result rgi_get_config(const rgi_stream_record *record, uint64_t i, rg_grid_config *config) {
    rg_grid_config given = {sizeof given, 0, 0, {0, 0, 0}, {0, 0, 0}, 0};
    given.kind = (rg_grid_kind)(uint32_t)rgi_word(record, i);
    given.resolution = (uint32_t)(rgi_word(record, i) >> 32);
    rgi_get_doubles(record, i + 1, given.lo, 3);
    rgi_get_doubles(record, i + 4, given.hi, 3);
    rgi_get_doubles(record, i + 7, &given.rebuild_factor, 1);
    return rgi_stream_blame(record, rgi_grid_config_read(config, &given));
}

/* ------------------------------------------------------------------------------------------ writing a shape */

/* A mesh as it was given: what its vertices and triangles are copied to. */
typedef struct mesh_data {
    rgi_memory *memory;
    double (*vertices)[3];
    uint32_t (*triangles)[3];
    uint32_t vertex_count, triangle_count;
} mesh_data;

static void mesh_free(mesh_data *data) {
    rgi_release(data->memory, data->vertices, data->vertex_count, sizeof *data->vertices);
    rgi_release(data->memory, data->triangles, data->triangle_count, sizeof *data->triangles);
}

#if defined(RGI_NO_MESH)
#define mesh_copy(memory, mesh, data) RG_OK
#else
static rg_result mesh_copy(rgi_memory *memory, const rgi_mesh *mesh, mesh_data *data) {
    data->memory = memory;
    data->vertex_count = mesh->vertex_count;
    data->triangle_count = mesh->triangle_count;
    rg_result result =
        rgi_allocate(memory, data->vertex_count, sizeof *data->vertices, "writing a mesh", &data->vertices);
    if (!result)
        result =
            rgi_allocate(memory, data->triangle_count, sizeof *data->triangles, "writing a mesh", &data->triangles);
    if (result) return result;
    rgi_mesh_read_vertices(mesh, data->vertices);
    rgi_mesh_read_triangles(mesh, data->triangles);
    return RG_OK;
}
#endif

static uint64_t mesh_words(uint64_t vertices, uint64_t triangles) {
    return 3 + 3 * vertices + (3 * triangles + 1) / 2;
}

static void put_mesh(rgi_writer *w, const mesh_data *data) {
    const uint32_t *index = data->triangles[0];
    uint64_t count = 3 * (uint64_t)data->triangle_count;
    rgi_put_head(w, RGI_RECORD_SHAPE, mesh_words(data->vertex_count, data->triangle_count));
    rgi_put(w, RG_SHAPE_MESH);
    rgi_put(w, data->vertex_count);
    rgi_put(w, data->triangle_count);
    for (uint32_t i = 0; i < data->vertex_count; i++) rgi_put_doubles(w, data->vertices[i], 3);
    for (uint64_t i = 0; i < count; i += 2) rgi_put_pair(w, index[i], i + 1 < count ? index[i + 1] : 0);
}

static void put_shape(rgi_writer *w, const rg_shape *shape, uint64_t user_number, const mesh_data *data) {
    switch (shape->kind) {
    case RG_SHAPE_SPHERE:
        rgi_put_head(w, RGI_RECORD_SHAPE, 2);
        rgi_put(w, RG_SHAPE_SPHERE);
        rgi_put_doubles(w, &shape->of.radius, 1);
        break;
    case RG_SHAPE_BOX:
        rgi_put_head(w, RGI_RECORD_SHAPE, 7);
        rgi_put(w, RG_SHAPE_BOX);
        rgi_put_doubles(w, shape->lo, 3);
        rgi_put_doubles(w, shape->hi, 3);
        break;
    case RG_SHAPE_CAPSULE:
        rgi_put_head(w, RGI_RECORD_SHAPE, 8);
        rgi_put(w, RG_SHAPE_CAPSULE);
        rgi_put_doubles(w, shape->of.capsule.a, 3);
        rgi_put_doubles(w, shape->of.capsule.b, 3);
        rgi_put_doubles(w, &shape->of.capsule.radius, 1);
        break;
    case RG_SHAPE_MESH:
        put_mesh(w, data);
        break;
    default:
        rgi_put_head(w, RGI_RECORD_SHAPE, 8);
        rgi_put(w, RG_SHAPE_USER);
        rgi_put(w, user_number);
        rgi_put_doubles(w, shape->lo, 3);
        rgi_put_doubles(w, shape->hi, 3);
        break;
    }
    rgi_put_end(w);
}

static rg_result number_of_user(const rgi_writer *w, const rg_shape *shape, uint64_t *number) {
    if (!w->sink.number_shape)
        return rgi_fail(RG_INVALID_ARGUMENT, "its shape is user-defined, and rg_sink.number_shape is NULL");
    if (w->sink.number_shape(w->sink.user, shape, shape->of.user.user, number) == 0) return RG_OK;
    return rgi_fail(RG_INVALID_ARGUMENT, "its shape is user-defined, and number_shape gives it no number");
}

rg_result rgi_write_shape(rgi_writer *w, rgi_shape_numbers *numbers, rg_shape *shape, uint32_t *number) {
    mesh_data data;
    uint64_t user_number = 0;
    rg_result result = RG_OK;
    if (rgi_shape_numbers_find(numbers, shape, number)) return RG_OK;
    memset(&data, 0, sizeof data);
    if (shape->kind == RG_SHAPE_USER) result = number_of_user(w, shape, &user_number);
    if (shape->kind == RG_SHAPE_MESH) result = mesh_copy(numbers->memory, shape->of.mesh, &data);
    if (!result) result = rgi_shape_numbers_add(numbers, shape, number);
    if (!result) put_shape(w, shape, user_number, &data);
    mesh_free(&data);
    return result;
}

/* ------------------------------------------------------------------------------------------ reading a shape */

static rg_result read_sphere(const rg_shape_config *config, const rgi_stream_record *record, rg_shape **shape) {
    double radius;
    rg_result result = rgi_stream_demand(record, 2);
    if (result) return result;
    rgi_get_doubles(record, 1, &radius, 1);
    return rg_shape_create_sphere(config, radius, shape);
}

static rg_result read_box(const rg_shape_config *config, const rgi_stream_record *record, rg_shape **shape) {
    double corners[2][3];
    rg_result result = rgi_stream_demand(record, 7);
    if (result) return result;
    rgi_get_doubles(record, 1, corners[0], 6);
    return rg_shape_create_box(config, corners[0], corners[1], shape);
}

static rg_result read_capsule(const rg_shape_config *config, const rgi_stream_record *record, rg_shape **shape) {
    double ends[2][3], radius;
    rg_result result = rgi_stream_demand(record, 8);
    if (result) return result;
    rgi_get_doubles(record, 1, ends[0], 6);
    rgi_get_doubles(record, 7, &radius, 1);
    return rg_shape_create_capsule(config, ends[0], ends[1], radius, shape);
}

static rg_result read_mesh(const rg_shape_config *config, const rgi_stream_record *record, rg_shape **shape) {
    uint64_t vertices = record->count > 2 ? rgi_word(record, 1) : 0;
    uint64_t triangles = record->count > 2 ? rgi_word(record, 2) : 0;
    if (vertices > record->count || triangles > record->count)
        return rgi_fail(RG_INVALID_DATA, "byte %" PRIu64 ": a mesh of %" PRIu64 " vertices and %" PRIu64 " triangles",
                        record->offset, vertices, triangles);
    rg_result result = rgi_stream_demand(record, mesh_words(vertices, triangles));
    if (result) return result;
    rg_mesh_views views;
    memset(&views, 0, sizeof views);
    views.size = sizeof views;
    views.vertex_count = vertices;
    views.triangle_count = triangles;
    views.vertices = rg_input3_packed(record->words + 3 * RGI_WORD, 3 * sizeof(double), RG_F64);
    views.indices = rg_input3_packed(record->words + (3 + 3 * vertices) * RGI_WORD, 3 * sizeof(uint32_t), RG_U32);
    return rg_shape_create_mesh(config, &views, shape);
}

/* What is wrong with the shape that the host has found; NULL: nothing. */
static const char *look_at_found(const rg_shape *shape, const double lo[3], const double hi[3]) {
    if (!shape) return "NULL";
    if (shape->kind != RG_SHAPE_USER) return "a shape that is not user-defined";
    bool same = memcmp(lo, shape->lo, sizeof shape->lo) == 0 && memcmp(hi, shape->hi, sizeof shape->hi) == 0;
    return same ? NULL : "a shape with another box";
}

static rg_result read_user(const rg_source *source, const rgi_stream_record *record, rg_shape **shape) {
    double lo[3], hi[3];
    rg_result result = rgi_stream_demand(record, 8);
    if (result) return result;
    uint64_t number = rgi_word(record, 1);
    rgi_get_doubles(record, 2, lo, 3);
    rgi_get_doubles(record, 5, hi, 3);
    if (!source->find_shape)
        return rgi_fail(RG_INVALID_DATA,
                        "byte %" PRIu64 ": user-defined shape number %" PRIu64 ", and rg_source.find_shape is NULL",
                        record->offset, number);
    if (source->find_shape(source->user, number, lo, hi, shape) != 0) {
        *shape = NULL;
        return rgi_fail(RG_CALLBACK_FAILED, "byte %" PRIu64 ": find_shape has no shape of number %" PRIu64,
                        record->offset, number);
    }
    const char *wrong = look_at_found(*shape, lo, hi);
    if (!wrong) return RG_OK;
    rg_shape_release(shape);
    return rgi_fail(RG_CALLBACK_FAILED, "byte %" PRIu64 ": find_shape gave %s for number %" PRIu64, record->offset,
                    wrong, number);
}

static rg_result make_shape(const rgi_loader *loader, const rgi_stream_record *record, rg_shape **shape) {
    switch (record->count ? rgi_word(record, 0) : UINT64_MAX) {
    case RG_SHAPE_SPHERE:
        return read_sphere(loader->source.shapes, record, shape);
    case RG_SHAPE_BOX:
        return read_box(loader->source.shapes, record, shape);
    case RG_SHAPE_CAPSULE:
        return read_capsule(loader->source.shapes, record, shape);
    case RG_SHAPE_MESH:
        return read_mesh(loader->source.shapes, record, shape);
    case RG_SHAPE_USER:
        return read_user(&loader->source, record, shape);
    default:
        return rgi_fail(RG_INVALID_DATA, "byte %" PRIu64 ": a shape of no kind", record->offset);
    }
}

static rg_result make_room(rgi_loader *loader) {
    rg_shape **shapes;
    uint64_t room = loader->shape_room ? 2 * loader->shape_room : 16;
    if (loader->shape_count < loader->shape_room) return RG_OK;
    rg_result result = rgi_allocate(&loader->memory, room, sizeof(rg_shape *), "the shapes of a file", &shapes);
    if (result) return result;
    if (loader->shape_count) memcpy(shapes, loader->shapes, loader->shape_count * sizeof *shapes);
    rgi_release(&loader->memory, loader->shapes, loader->shape_room, sizeof *shapes);
    loader->shapes = shapes;
    loader->shape_room = room;
    return RG_OK;
}

rg_result rgi_read_shape(rgi_loader *loader, const rgi_stream_record *record) {
    rg_shape *shape = NULL;
    rg_result result = make_room(loader);
    if (!result) result = rgi_stream_blame(record, make_shape(loader, record, &shape));
    if (!result) loader->shapes[loader->shape_count++] = shape;
    return result;
}

rg_result rgi_find_shape(const rgi_loader *loader, const rgi_stream_record *record, uint32_t number,
                         rg_shape **shape) {
    if (number < loader->shape_count) {
        *shape = loader->shapes[number];
        return RG_OK;
    }
    return rgi_fail(RG_INVALID_DATA, "byte %" PRIu64 ": shape %" PRIu32 " of %" PRIu64, record->offset, number,
                    loader->shape_count);
}
