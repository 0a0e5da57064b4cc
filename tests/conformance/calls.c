/* SPDX-License-Identifier: MIT */
#include "calls.h"

#include "trace.h"

#include <stdlib.h>
#include <string.h>

/* A block of memory for the arrays of one call. */
static void *block(context *c, size_t count, size_t size) {
    void *memory = calloc(count ? count : 1, size);
    if (!memory) malformed(c, "out of memory for %zu records", count);
    return memory;
}

/* ------------------------------------------------------------------------------------------------- shapes */

static rg_result keep_shape(context *c, const json_t *step, rg_result result, rg_shape *const *shape) {
    if (result == RG_OK) names_add(&c->shapes, read_text(c, step, "shape"), 0)->shape = *shape;
    return result;
}

static rg_result call_sphere(context *c, const json_t *step) {
    rg_shape *shape = NULL;
    double radius = read_number(c, json_object_get(step, "radius"));
    if (c->broken) return MALFORMED;
    return keep_shape(c, step, rg_shape_create_sphere(NULL, radius, &shape), &shape);
}

static rg_result call_box(context *c, const json_t *step) {
    rg_shape *shape = NULL;
    double lo[3], hi[3];
    read_numbers(c, step, "lo", 3, lo);
    read_numbers(c, step, "hi", 3, hi);
    if (c->broken) return MALFORMED;
    return keep_shape(c, step, rg_shape_create_box(NULL, lo, hi, &shape), &shape);
}

static rg_result call_capsule(context *c, const json_t *step) {
    rg_shape *shape = NULL;
    double a[3], b[3], radius = read_number(c, json_object_get(step, "radius"));
    read_numbers(c, step, "a", 3, a);
    read_numbers(c, step, "b", 3, b);
    if (c->broken) return MALFORMED;
    return keep_shape(c, step, rg_shape_create_capsule(NULL, a, b, radius, &shape), &shape);
}

/* Vertices as packed doubles or floats. */
static void *vertex_block(context *c, const json_t *array, bool as_float) {
    size_t count = json_array_size(array);
    double *wide = block(c, 3 * count, sizeof *wide);
    for (size_t i = 0; wide && i < count; i++) read_vector(c, json_array_get(array, i), wide + 3 * i);
    float *narrow = as_float && wide ? block(c, 3 * count, sizeof *narrow) : NULL;
    if (!narrow) return wide;
    for (size_t i = 0; i < 3 * count; i++) narrow[i] = (float)wide[i];
    free(wide);
    return narrow;
}

static void write_index(unsigned char *at, size_t size, uint64_t value) {
    uint16_t two = (uint16_t)value;
    uint32_t four = (uint32_t)value;
    if (size == 2) memcpy(at, &two, size);
    if (size == 4) memcpy(at, &four, size);
    if (size == 8) memcpy(at, &value, size);
}

static void *index_block(context *c, const json_t *array, size_t size) {
    size_t count = json_array_size(array);
    unsigned char *memory = block(c, 3 * count, size);
    for (size_t i = 0; memory && i < 3 * count; i++) {
        const json_t *value = json_array_get(json_array_get(array, i / 3), i % 3);
        if (!json_is_integer(value)) malformed(c, "an index is no whole number");
        write_index(memory + i * size, size, (uint64_t)json_integer_value(value));
    }
    return memory;
}

static bool text_is(const json_t *object, const char *key, const char *wanted) {
    const char *text = json_string_value(json_object_get(object, key));
    return text && strcmp(text, wanted) == 0;
}

/* Three numbers a record, of `size` bytes each: one after another, or each in an array of its own. */
static rg_input3 view_of(const void *packed, size_t count, size_t size, rg_type type, void *apart) {
    unsigned char *column = apart;
    if (!apart) return rg_input3_packed(packed, (ptrdiff_t)(3 * size), type);
    for (size_t i = 0; i < 3 * count; i++)
        memcpy(column + (i % 3 * count + i / 3) * size, (const unsigned char *)packed + i * size, size);
    const rg_input3 view = {column, column + count * size, column + 2 * count * size, (ptrdiff_t)size, type};
    return view;
}

/* The memory of a mesh as the host has it. */
typedef struct mesh_data {
    rg_mesh_views views;
    void *vertices, *vertices_apart, *indices, *indices_apart;
} mesh_data;

static mesh_data read_mesh(context *c, const json_t *step) {
    const json_t *vertices = read_array(c, step, "vertices"), *indices = json_object_get(step, "indices");
    bool as_float = text_is(step, "vertex_type", "f32"), apart = json_is_true(json_object_get(step, "apart"));
    size_t of_vertex = as_float ? sizeof(float) : sizeof(double);
    size_t of_index = text_is(step, "index_type", "u16") ? 2 : text_is(step, "index_type", "u64") ? 8 : 4;
    rg_type index_type = of_index == 2 ? RG_U16 : of_index == 8 ? RG_U64 : RG_U32;
    mesh_data m;
    memset(&m, 0, sizeof m);
    m.views.size = sizeof m.views;
    m.views.vertex_count = json_array_size(vertices);
    m.views.triangle_count = indices ? json_array_size(indices) : m.views.vertex_count / 3;
    m.vertices = vertex_block(c, vertices, as_float);
    if (indices) m.indices = index_block(c, indices, of_index);
    if (apart) m.vertices_apart = block(c, 3 * m.views.vertex_count, of_vertex);
    if (apart && indices) m.indices_apart = block(c, 3 * m.views.triangle_count, of_index);
    if (c->broken) return m;
    m.views.vertices =
        view_of(m.vertices, m.views.vertex_count, of_vertex, as_float ? RG_F32 : RG_F64, m.vertices_apart);
    if (indices) m.views.indices = view_of(m.indices, m.views.triangle_count, of_index, index_type, m.indices_apart);
    return m;
}

static void free_mesh(mesh_data *m) {
    free(m->vertices);
    free(m->vertices_apart);
    free(m->indices);
    free(m->indices_apart);
}

static rg_shape_config read_making(context *c, const json_t *step) {
    rg_shape_config config;
    const json_t *quality = json_object_get(step, "quality");
    rg_shape_config_default(&config, sizeof config);
    if (text_is(step, "quality", "fast"))
        config.quality = RG_MESH_FAST;
    else if (json_is_integer(quality))
        config.quality = (rg_mesh_quality)json_integer_value(quality);
    else if (quality && !text_is(step, "quality", "best"))
        malformed(c, "unknown quality");
    return config;
}

static rg_result call_mesh(context *c, const json_t *step) {
    mesh_data m = read_mesh(c, step);
    const rg_shape_config config = read_making(c, step);
    rg_shape *shape = NULL;
    rg_result result = MALFORMED;
    if (!c->broken) result = keep_shape(c, step, rg_shape_create_mesh(&config, &m.views, &shape), &shape);
    free_mesh(&m);
    return result;
}

static rg_result call_deform(context *c, const json_t *step) {
    const rg_shape *from = read_shape(c, read_text(c, step, "from"));
    const rg_shape_config config = read_making(c, step);
    mesh_data m = read_mesh(c, step);
    rg_shape *shape = NULL;
    rg_result result = MALFORMED;
    if (!c->broken) result = keep_shape(c, step, rg_shape_create_deformed(&config, from, &m.views, &shape), &shape);
    free_mesh(&m);
    return result;
}

static rg_result call_replace_shape(context *c, const json_t *step) {
    rg_shape *from = read_shape(c, read_text(c, step, "from")), *to = read_shape(c, read_text(c, step, "to"));
    return c->broken ? MALFORMED : rg_scene_replace_shape(c->scene, from, to);
}

static rg_result call_release(context *c, const json_t *step) {
    const char *name = read_text(c, step, "shape");
    read_shape(c, name);
    if (c->broken) return MALFORMED;
    rg_shape_release(&names_find(&c->shapes, name)->shape);
    return RG_OK;
}

/* ------------------------------------------------------------------------------------------------ objects */

/* The views of `count` poses; the columns of linear parts only if there are some. */
static rg_pose_views pose_views(const rg_pose *poses, bool linear) {
    rg_pose_views views;
    memset(&views, 0, sizeof views);
    views.size = sizeof views;
    views.position = rg_input3_packed(poses->position, sizeof *poses, RG_F64);
    for (int j = 0; linear && j < 3; j++) {
        const rg_input3 column = {&poses->linear[j], &poses->linear[3 + j], &poses->linear[6 + j], sizeof *poses,
                                  RG_F32};
        views.column[j] = column;
    }
    return views;
}

static rg_pose *read_poses(context *c, const json_t *step, size_t count) {
    const json_t *positions = read_array(c, step, "positions"), *linears = json_object_get(step, "linears");
    rg_pose *poses = block(c, count, sizeof *poses);
    if (json_array_size(positions) != count) malformed(c, "positions are not one for each object");
    if (linears && json_array_size(linears) != count) malformed(c, "linears are not one for each object");
    for (size_t i = 0; poses && !c->broken && i < count; i++) {
        json_t *one = json_object();
        json_object_set(one, "position", json_array_get(positions, i));
        if (linears) json_object_set(one, "linear", json_array_get(linears, i));
        poses[i] = read_pose(c, one);
        json_decref(one);
    }
    return poses;
}

static rg_result keep_objects(context *c, const char *name, rg_result result, const rg_object *ids, size_t count,
                              bool many) {
    if (result != RG_OK) return result;
    named *item = names_add(&c->objects, name, count);
    item->many = many;
    if (count) memcpy(item->values, ids, count * sizeof *ids);
    return result;
}

static rg_result call_insert(context *c, const json_t *step) {
    rg_object id = RG_NO_OBJECT;
    rg_shape *shape = read_shape(c, read_text(c, step, "shape"));
    rg_pose pose = read_pose(c, step);
    bool plain = !json_object_get(step, "mask") && !json_object_get(step, "grid");
    uint32_t mask = (uint32_t)read_integer(c, step, "mask", UINT32_MAX, UINT32_MAX);
    rg_grid grid = json_object_get(step, "grid") ? read_grid(c, step, "grid") : RG_GRID_OF_SCENE;
    if (c->broken) return MALFORMED;
    rg_result result;
    if (plain) {
        result = rg_scene_insert(c->scene, shape, &pose, &id);
    } else {
        const rg_pose_views poses = pose_views(&pose, true);
        const rg_insert_views views = {sizeof views, &shape, 0, &poses, {&mask, 0, RG_U32}, grid, 0};
        const rg_output out = {&id, 0, RG_U64};
        result = rg_scene_insert_many(c->scene, &views, 1, &out);
    }
    return keep_objects(c, read_text(c, step, "object"), result, &id, 1, false);
}

static rg_result insert_poses(context *c, const json_t *step, rg_shape **shapes, bool one_shape, const rg_pose *poses,
                              const uint32_t *masks, size_t count) {
    rg_object *ids = block(c, count, sizeof *ids);
    const rg_output out = {ids, sizeof *ids, RG_U64};
    rg_insert_views views;
    memset(&views, 0, sizeof views);
    views.size = sizeof views;
    views.shapes = shapes;
    views.shapes_stride = one_shape ? 0 : (ptrdiff_t)sizeof *shapes;
    views.grid = json_object_get(step, "grid") ? read_grid(c, step, "grid") : RG_GRID_OF_SCENE;
    rg_result result = MALFORMED;
    if (!c->broken) {
        const rg_pose_views placed = pose_views(poses, json_object_get(step, "linears") != NULL);
        views.poses = &placed;
        if (masks) views.mask = (rg_input){masks, sizeof *masks, RG_U32};
        result = rg_scene_insert_many(c->scene, &views, count, &out);
        keep_objects(c, read_text(c, step, "objects"), result, ids, count, true);
    }
    free(ids);
    return result;
}

static rg_result call_insert_many(context *c, const json_t *step) {
    size_t count = json_array_size(read_array(c, step, "positions"));
    const json_t *each = json_object_get(step, "shapes"), *given = json_object_get(step, "masks");
    rg_pose *poses = read_poses(c, step, count);
    rg_shape **shapes = block(c, count, sizeof *shapes);
    uint32_t *masks = block(c, count, sizeof *masks);
    if (each && json_array_size(each) != count) malformed(c, "shapes are not one for each object");
    if (given && json_array_size(given) != count) malformed(c, "masks are not one for each object");
    for (size_t i = 0; i < count && !c->broken; i++) {
        const char *name = json_string_value(json_array_get(each, i));
        shapes[i] = read_shape(c, each ? (name ? name : "") : read_text(c, step, "shape"));
        masks[i] = (uint32_t)json_integer_value(json_array_get(given, i));
    }
    rg_result result = insert_poses(c, step, shapes, !each, poses, given ? masks : NULL, count);
    free(poses);
    free(shapes);
    free(masks);
    return result;
}

static rg_result call_insert_line(context *c, const json_t *step) {
    double start[3], each[3];
    size_t count = (size_t)read_integer(c, step, "count", 1u << 30, 0);
    rg_pose *poses = block(c, count, sizeof *poses);
    rg_shape *shape = read_shape(c, read_text(c, step, "shape"));
    read_numbers(c, step, "start", 3, start);
    read_numbers(c, step, "step", 3, each);
    for (size_t i = 0; i < count && !c->broken; i++) {
        double n = (double)i;
        poses[i] = rg_pose_at(start[0] + n * each[0], start[1] + n * each[1], start[2] + n * each[2]);
    }
    rg_result result = insert_poses(c, step, &shape, true, poses, NULL, count);
    free(poses);
    return result;
}

static rg_result call_move(context *c, const json_t *step) {
    rg_object id = read_object(c, json_object_get(step, "object"));
    rg_pose pose = read_pose(c, step);
    return c->broken ? MALFORMED : rg_scene_move(c->scene, id, &pose);
}

static rg_result call_move_to(context *c, const json_t *step) {
    rg_object id = read_object(c, json_object_get(step, "object"));
    double position[3];
    read_numbers(c, step, "position", 3, position);
    return c->broken ? MALFORMED : rg_scene_move_to(c->scene, id, position);
}

static rg_object *read_objects(context *c, const json_t *step, size_t *count) {
    const json_t *array = read_array(c, step, "objects");
    *count = json_array_size(array);
    rg_object *ids = block(c, *count, sizeof *ids);
    for (size_t i = 0; ids && i < *count; i++) ids[i] = read_object(c, json_array_get(array, i));
    return ids;
}

static rg_result call_move_many(context *c, const json_t *step) {
    size_t count;
    rg_object *ids = read_objects(c, step, &count);
    rg_pose *poses = read_poses(c, step, count);
    rg_result result = MALFORMED;
    if (!c->broken) {
        const rg_input objects = {ids, sizeof *ids, RG_U64};
        const rg_pose_views views = pose_views(poses, json_object_get(step, "linears") != NULL);
        result = rg_scene_move_many(c->scene, &objects, &views, count);
    }
    free(ids);
    free(poses);
    return result;
}

static rg_result call_set_mask(context *c, const json_t *step) {
    rg_object id = read_object(c, json_object_get(step, "object"));
    uint32_t mask = (uint32_t)read_integer(c, step, "mask", UINT32_MAX, 0);
    return c->broken ? MALFORMED : rg_scene_set_mask(c->scene, id, mask);
}

static rg_result call_remove(context *c, const json_t *step) {
    rg_object id = read_object(c, json_object_get(step, "object"));
    return c->broken ? MALFORMED : rg_scene_remove(c->scene, id);
}

static rg_result call_remove_many(context *c, const json_t *step) {
    size_t count;
    rg_object *ids = read_objects(c, step, &count);
    const rg_input objects = {ids, sizeof *ids, RG_U64};
    rg_result result = c->broken ? MALFORMED : rg_scene_remove_many(c->scene, &objects, count);
    free(ids);
    return result;
}

static rg_result call_lookup(context *c, const json_t *step) {
    rg_object id = read_object(c, json_object_get(step, "object"));
    rg_object_report report = {.size = sizeof report};
    return c->broken ? MALFORMED : rg_scene_lookup(c->scene, id, &report);
}

/* -------------------------------------------------------------------------------------------------- grids */

static rg_result call_create_grid(context *c, const json_t *step) {
    rg_grid grid = 0;
    rg_grid_config config = read_grid_config(c, json_object_get(step, "config"));
    if (c->broken) return MALFORMED;
    rg_result result = rg_grid_create(c->scene, &config, &grid);
    if (result == RG_OK) names_add(&c->grids, read_text(c, step, "grid"), 1)->values[0] = grid;
    return result;
}

static rg_result call_configure_grid(context *c, const json_t *step) {
    rg_grid grid = read_grid(c, step, "grid");
    rg_grid_config config = read_grid_config(c, json_object_get(step, "config"));
    return c->broken ? MALFORMED : rg_grid_configure(c->scene, grid, &config);
}

static rg_result call_rebuild_grid(context *c, const json_t *step) {
    rg_grid grid = read_grid(c, step, "grid");
    return c->broken ? MALFORMED : rg_grid_rebuild(c->scene, grid);
}

static rg_result call_destroy_grid(context *c, const json_t *step) {
    rg_grid grid = read_grid(c, step, "grid");
    return c->broken ? MALFORMED : rg_grid_destroy(c->scene, grid);
}

static rg_result call_grid_stats(context *c, const json_t *step) {
    rg_grid grid = read_grid(c, step, "grid");
    rg_grid_report report = {.size = sizeof report};
    return c->broken ? MALFORMED : rg_grid_stats(c->scene, grid, &report);
}

/* ------------------------------------------------------------------------------------------------ the set */

static const struct {
    const char *name, *keys;
    rg_result (*call)(context *c, const json_t *step);
} calls[] = {
    {"sphere", "do shape radius", call_sphere},
    {"box", "do shape lo hi", call_box},
    {"capsule", "do shape a b radius", call_capsule},
    {"mesh", "do shape vertices vertex_type indices index_type apart quality", call_mesh},
    {"deform", "do shape from vertices vertex_type apart quality", call_deform},
    {"replace_shape", "do from to", call_replace_shape},
    {"release", "do shape", call_release},
    {"insert", "do object shape position linear mask grid", call_insert},
    {"insert_many", "do objects shape shapes positions linears masks grid", call_insert_many},
    {"insert_line", "do objects shape start step count grid", call_insert_line},
    {"move", "do object position linear", call_move},
    {"move_to", "do object position", call_move_to},
    {"move_many", "do objects positions linears", call_move_many},
    {"set_mask", "do object mask", call_set_mask},
    {"remove", "do object", call_remove},
    {"remove_many", "do objects", call_remove_many},
    {"lookup", "do object", call_lookup},
    {"create_grid", "do grid config", call_create_grid},
    {"configure_grid", "do grid config", call_configure_grid},
    {"rebuild_grid", "do grid", call_rebuild_grid},
    {"destroy_grid", "do grid", call_destroy_grid},
    {"grid_stats", "do grid", call_grid_stats},
    {"trace", "do rays cull respawn", trace_once},
};

rg_result call_step(context *c, const json_t *step, bool *known) {
    const char *name = read_text(c, step, "do");
    *known = false;
    for (size_t i = 0; i < sizeof calls / sizeof *calls; i++) {
        if (strcmp(calls[i].name, name) != 0) continue;
        *known = true;
        read_known_keys(c, step, calls[i].keys);
        return c->broken ? MALFORMED : calls[i].call(c, step);
    }
    return MALFORMED;
}
