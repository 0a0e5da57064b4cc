/* SPDX-License-Identifier: MIT */
#include "world.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void world_fail(const world *w, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    fflush(stdout);
    fprintf(stderr, "FAILED: %s, seed %" PRIu64 ", step %" PRIu64 ": ", w->name, w->seed, w->step);
    vfprintf(stderr, format, arguments);
    fprintf(stderr, "\n");
    va_end(arguments);
    exit(EXIT_FAILURE);
}

void world_expect(const world *w, const char *call, rg_result got, rg_result want) {
    if (got == want) return;
    world_fail(w, "%s returned %s, expected %s; last message: %s", call, rg_result_name(got), rg_result_name(want),
               rg_error_message());
}

void world_dump_ray(const rg_ray *ray) {
    fprintf(stderr, "  ray origin {%a, %a, %a} direction {%a, %a, %a} t %a to %a mask 0x%08" PRIx32 "\n",
            ray->origin[0], ray->origin[1], ray->origin[2], ray->direction[0], ray->direction[1], ray->direction[2],
            ray->t_min, ray->t_max, ray->mask);
}

void world_dump_object(const world *w, const char *which, rg_object id) {
    if (!reference_has(w->reference, id)) return;
    rg_object_report object = {.size = sizeof object};
    rg_shape_report shape = {.size = sizeof shape};
    const rg_pose *pose = reference_pose(w->reference, id);
    if (rg_scene_lookup(w->scene, id, &object) == RG_OK) rg_shape_stats(object.shape, &shape);
    fprintf(stderr, "  %s object: shape kind %d, local box (%a, %a, %a) to (%a, %a, %a)\n", which, (int)shape.kind,
            shape.lo[0], shape.lo[1], shape.lo[2], shape.hi[0], shape.hi[1], shape.hi[2]);
    fprintf(stderr, "  at (%a, %a, %a), linear by rows", pose->position[0], pose->position[1], pose->position[2]);
    for (int i = 0; i < 9; i++) fprintf(stderr, " %a", pose->linear[i]);
    fprintf(stderr, ", scale %a\n", pose->scale);
}

void world_create(world *w, const char *name, uint64_t seed, const rg_scene_config *config,
                  const rg_grid_config *more, int more_count) {
    memset(w, 0, sizeof *w);
    w->name = name;
    w->seed = seed;
    w->random.state = seed;
    w->spread = 100;
    w->least_decade = -3;
    w->most_decade = 1;
    w->most_at_once = 32;
    world_expect(w, "rg_scene_create", rg_scene_create(config, &w->scene), RG_OK);
    w->reference = reference_create();
    w->grid_count = 1; /* grids[0] is RG_GRID_OF_SCENE */
    for (int i = 0; i < more_count; i++)
        world_expect(w, "rg_grid_create", rg_grid_create(w->scene, &more[i], &w->grids[w->grid_count++]), RG_OK);
    world_make_shapes(w);
}

void world_destroy(world *w) {
    rg_scene_report report = {.size = sizeof report};
    while (reference_count(w->reference) > 0) world_remove_one(w);
    world_expect(w, "rg_scene_stats", rg_scene_stats(w->scene, &report), RG_OK);
    if (report.objects != 0) world_fail(w, "objects are left in an empty scene");
    world_expect(w, "rg_scene_destroy", rg_scene_destroy(&w->scene), RG_OK);
    if (w->scene) world_fail(w, "rg_scene_destroy left the pointer");
    for (int i = 0; i < w->shape_count; i++) rg_shape_release(&w->shapes[i].shape);
    if (w->users_alive != 0) world_fail(w, "%d user shapes were not destroyed", w->users_alive);
    reference_destroy(w->reference);
}
