/* SPDX-License-Identifier: MIT */
/*
 * record.c: a host that records what it does with its scene, so that a bug report is a file.
 *
 *     record FILE && raygrid-replay FILE --ray 0 0 -9 0 0 1
 *
 * Balls and a shape of the host's own go round; each call is in the file before it returns. Should the program die,
 * the file is good up to the last call.
 */
#include <raygrid/raygrid.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { BALLS = 20, FRAMES = 50 };

static void demand(rg_result result, const char *call) {
    if (result == RG_OK) return;
    fprintf(stderr, "%s: %s: %s\n", call, rg_result_name(result), rg_error_message());
    exit(1);
}

/* Where the recording goes: not buffered, so that nothing is lost with the process. */
static int32_t write_to_file(void *user, const void *bytes, size_t size) {
    return fwrite(bytes, 1, size, user) == size ? 0 : -1;
}

/* The host's own shape: the plane z = 0 within a square. Its number is what the file knows it by. */
typedef struct square {
    uint64_t number;
    double half;
} square;

static int32_t square_intersect(void *user, const rg_local_ray *ray, rg_local_hit *hit) {
    const square *s = user;
    const double t = -ray->origin[2] / ray->direction[2];
    const rg_local_hit found = {.t = t, .normal = {0, 0, 1}};
    if (!(t >= ray->t_min && t <= ray->t_max)) return 0;
    if (fabs(ray->origin[0] + t * ray->direction[0]) > s->half) return 0;
    if (fabs(ray->origin[1] + t * ray->direction[1]) > s->half) return 0;
    *hit = found;
    return 1;
}

static int32_t square_number(void *user, const rg_shape *shape, void *shape_user, uint64_t *number) {
    (void)user, (void)shape;
    *number = ((const square *)shape_user)->number;
    return 0;
}

static void make_shapes(rg_shape **ball, rg_shape **own) {
    static square s = {.number = 1001, .half = 2};
    const rg_user_shape definition = {
        .size = sizeof definition, .user = &s, .lo = {-2, -2, 0}, .hi = {2, 2, 0}, .intersect = square_intersect};
    demand(rg_shape_create_sphere(NULL, 0.5, ball), "rg_shape_create_sphere");
    demand(rg_shape_create_user(NULL, &definition, own), "rg_shape_create_user");
}

/* What the host does all day. */
static void run(rg_scene *scene, rg_shape *ball, rg_shape *own) {
    rg_object balls[BALLS], sign;
    demand(rg_scene_insert(scene, own, NULL, &sign), "rg_scene_insert");
    for (int i = 0; i < BALLS; i++) {
        const rg_pose pose = rg_pose_at(i, 0, 5);
        demand(rg_scene_insert(scene, ball, &pose, &balls[i]), "rg_scene_insert");
    }
    for (int frame = 0; frame < FRAMES; frame++) {
        for (int i = 0; i < BALLS; i++) {
            const double place[3] = {i + 0.125 * frame, 0.25 * frame, 5};
            demand(rg_scene_move_to(scene, balls[i], place), "rg_scene_move_to");
        }
        demand(rg_scene_set_mask(scene, sign, frame % 2 ? 1 : 3), "rg_scene_set_mask");
    }
    demand(rg_scene_remove(scene, balls[0]), "rg_scene_remove");
}

int main(int argc, char **argv) {
    rg_scene *scene;
    rg_shape *ball, *own;
    FILE *file = argc == 2 ? fopen(argv[1], "wb") : NULL;
    rg_sink sink = {.size = sizeof sink, .user = file, .write = write_to_file, .number_shape = square_number};
    if (!file) {
        fprintf(stderr, "usage: record FILE\n");
        return 2;
    }
    setvbuf(file, NULL, _IONBF, 0);
    make_shapes(&ball, &own);
    demand(rg_scene_create(NULL, &scene), "rg_scene_create");
    demand(rg_scene_record(scene, &sink), "rg_scene_record");
    run(scene, ball, own);
    demand(rg_scene_record(scene, NULL), "rg_scene_record");
    rg_shape_release(&ball);
    rg_shape_release(&own);
    rg_scene_destroy(&scene);
    return fclose(file) == 0 ? 0 : 1;
}
