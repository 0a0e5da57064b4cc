/* SPDX-License-Identifier: MIT */
/*
 * memory: every allocation of a long scenario fails once, and once it fails with all that follow; for each kind of
 * grid as the scene's own. Whatever call meets
 * the failure returns RG_OUT_OF_MEMORY and has changed nothing, or succeeds as if nothing were amiss (where the
 * memory would only have made it faster). Afterwards all goes on as if it had never failed, and in the end all memory
 * is back.
 */
#include "allocator.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MANY = 200, OBJECTS = 1024, PROBES = 24, SHAPES = 9, INSERTED = 5, SIDE = 12 };

enum { BALL, CUBE, PILL, SOLID, OWN, BENT, HASTY, LENT, LENT_AGAIN };

typedef struct scenario {
    test_allocator memory;
    rg_scene *scene;
    rg_shape *shapes[SHAPES];
    rg_grid_kind kind, other; /* of the scene's own grid, and of the second at first */
    rg_grid grid, spare;
    rg_object objects[OBJECTS];
    uint32_t count; /* of objects */
    uint64_t turns; /* so far: what a step does follows from it alone */
    int own_destroyed, given_back;
} scenario;

typedef struct probe {
    rg_hit hits[PROBES];
    uint64_t objects, slots;
    uint32_t grids;
} probe;

typedef rg_result step_function(scenario *s, uint32_t argument);

typedef struct step {
    const char *name;
    step_function *run;
    uint32_t argument, repeat;
    bool needs_none; /* does without memory if there is none */
} step;

static void fail(const char *step_name, uint32_t turn, const char *why) {
    fprintf(stderr, "FAILED: %s (turn %" PRIu32 "): %s\n", step_name, turn, why);
    exit(EXIT_FAILURE);
}

/* ---------------------------------------------------------------------------------------------- the steps */

static int32_t own_intersect(void *user, const rg_local_ray *ray, rg_local_hit *hit) {
    (void)user;
    /* The plane x = 0 within the unit square. */
    double t = -ray->origin[0] / ray->direction[0];
    if (!(t >= ray->t_min && t <= ray->t_max)) return 0;
    for (int i = 1; i < 3; i++) {
        if (fabs(ray->origin[i] + t * ray->direction[i]) > 1) return 0;
    }
    *hit = (rg_local_hit){.t = t, .normal = {-1, 0, 0}};
    return 1;
}

static void own_destroy(void *user) {
    ++*(int *)user;
}

static rg_result make_scene(scenario *s, uint32_t workers) {
    const rg_grid_config grid = {.size = sizeof grid, .kind = s->kind};
    rg_scene_config config = {.size = sizeof config, .workers = workers, .grid = &grid};
    config.allocator = test_allocator_hooks(&s->memory);
    return rg_scene_create(&config, &s->scene);
}

/* A dented square of SIDE x SIDE quads, each cut in two. `mesh`: the one that is to be as deep as that; or NULL. */
static rg_result make_mesh(const rg_shape_config *config, const rg_shape *mesh, float depth, rg_shape **shape) {
    enum { ROW = SIDE + 1 };
    static float vertices[ROW * ROW][3];
    static uint16_t indices[SIDE * SIDE * 2][3];
    for (int i = 0; i < ROW * ROW; i++) {
        vertices[i][0] = 2 * (float)(i % ROW) / SIDE - 1;
        vertices[i][1] = 2 * (float)(i / ROW) / SIDE - 1;
        vertices[i][2] = depth * (float)(i % 7);
    }
    for (int i = 0; i < SIDE * SIDE; i++) {
        int corner = i / SIDE * ROW + i % SIDE;
        const int two[2][3] = {{corner, corner + 1, corner + ROW + 1}, {corner, corner + ROW + 1, corner + ROW}};
        for (int k = 0; k < 6; k++) indices[2 * i + k / 3][k % 3] = (uint16_t)two[k / 3][k % 3];
    }
    rg_mesh_views views = {.size = sizeof views, .vertex_count = ROW * ROW, .triangle_count = SIDE * SIDE * 2};
    views.vertices = rg_input3_packed(vertices, sizeof vertices[0], RG_F32);
    views.indices = rg_input3_packed(indices, sizeof indices[0], RG_U16);
    return mesh ? rg_shape_create_deformed(config, mesh, &views, shape) : rg_shape_create_mesh(config, &views, shape);
}

/* The data of a mesh that is read where it lies. */
typedef struct loan {
    double vertices[12][3];
    uint32_t indices[4][3];
    scenario *s;
} loan;

static void give_back(void *user) {
    ((loan *)user)->s->given_back++;
    free(user);
}

/* Four triangles that share nothing, by indices. `mesh`: the one that is to be as large as that; or NULL. */
static rg_result borrow(scenario *s, const rg_shape_config *config, const rg_shape *mesh, double size,
                        rg_shape **shape) {
    int given_back = s->given_back;
    loan *l = malloc(sizeof *l);
    if (!l) fail("the test", 0, "out of memory");
    l->s = s;
    for (int i = 0; i < 12; i++) {
        for (int a = 0; a < 3; a++) l->vertices[i][a] = size * cos(5 * i + a);
        l->indices[i / 3][i % 3] = (uint32_t)(11 - i);
    }
    rg_mesh_views views = {
        .size = sizeof views, .vertex_count = 12, .triangle_count = 4, .released = give_back, .user = l};
    views.vertices = rg_input3_packed(l->vertices, sizeof *l->vertices, RG_F64);
    views.indices = rg_input3_packed(l->indices, sizeof *l->indices, RG_U32);
    rg_result result =
        mesh ? rg_shape_create_deformed(config, mesh, &views, shape) : rg_shape_create_mesh(config, &views, shape);
    if (s->given_back != given_back) fail("borrow", 0, "the data is given back already");
    if (result != RG_OK) free(l);
    return result;
}

static rg_result make_shape(scenario *s, uint32_t which) {
    static const double LO[3] = {-1, -1, -1}, HI[3] = {1, 1, 1};
    rg_shape_config config = {.size = sizeof config, .allocator = test_allocator_hooks(&s->memory)};
    rg_user_shape own = {.size = sizeof own, .user = &s->own_destroyed, .lo = {-1, -1, -1}, .hi = {1, 1, 1}};
    own.intersect = own_intersect;
    own.destroy = own_destroy;
    switch (which) {
    case BALL:
        return rg_shape_create_sphere(&config, 1, &s->shapes[BALL]);
    case CUBE:
        return rg_shape_create_box(&config, LO, HI, &s->shapes[CUBE]);
    case PILL:
        return rg_shape_create_capsule(&config, LO, HI, 0.5, &s->shapes[PILL]);
    case SOLID:
        return make_mesh(&config, NULL, 0.1f, &s->shapes[SOLID]);
    case BENT:
        return make_mesh(&config, s->shapes[SOLID], 0.3f, &s->shapes[BENT]);
    case HASTY:
        config.quality = RG_MESH_FAST;
        return make_mesh(&config, NULL, 0.2f, &s->shapes[HASTY]);
    case LENT:
        return borrow(s, &config, NULL, 1, &s->shapes[LENT]);
    case LENT_AGAIN:
        return borrow(s, &config, s->shapes[LENT], 1.1, &s->shapes[LENT_AGAIN]);
    default:
        return rg_shape_create_user(&config, &own, &s->shapes[OWN]);
    }
}

/* Spread over a cube whose side grows with the number, so that tiles, cells and boxes have to follow. */
static rg_pose pose_of(uint32_t number, double scale) {
    double at = scale * (1 + 0.01 * number);
    rg_pose pose = rg_pose_at(at * cos(number), at * sin(1.7 * number), at * cos(2.3 * number + 1));
    if (number % 3 == 0) pose.linear[0] = 2;
    if (number % 5 == 0) pose.linear[1] = 0.5f;
    return pose;
}

static rg_result insert_one(scenario *s, uint32_t scale) {
    rg_pose pose = pose_of(s->count, scale);
    rg_result result = rg_scene_insert(s->scene, s->shapes[s->count % INSERTED], &pose, &s->objects[s->count]);
    if (result == RG_OK) s->count++;
    return result;
}

static rg_result insert_many(scenario *s, uint32_t into_second_grid) {
    rg_shape *shapes[MANY];
    rg_pose poses[MANY];
    for (uint32_t i = 0; i < MANY; i++) {
        shapes[i] = s->shapes[i % INSERTED];
        poses[i] = pose_of(s->count + i, 20);
    }
    rg_insert_views views = {.size = sizeof views, .shapes = shapes, .shapes_stride = sizeof *shapes};
    rg_pose_views pose_views = {.size = sizeof pose_views};
    pose_views.position = rg_input3_packed(poses[0].position, sizeof *poses, RG_F64);
    for (int k = 0; k < 3; k++) {
        const float *top = poses[0].linear + k;
        pose_views.column[k] = (rg_input3){top, top + 3, top + 6, sizeof *poses, RG_F32};
    }
    views.poses = &pose_views;
    views.grid = into_second_grid ? s->grid : RG_GRID_OF_SCENE;
    rg_output out = {s->objects + s->count, sizeof *s->objects, RG_U64};
    rg_result result = rg_scene_insert_many(s->scene, &views, MANY, &out);
    if (result == RG_OK) s->count += MANY;
    return result;
}

static rg_result move_one(scenario *s, uint32_t scale) {
    rg_pose pose = pose_of(7 + s->count, scale);
    return rg_scene_move(s->scene, s->objects[s->count / 2], &pose);
}

static rg_result move_to(scenario *s, uint32_t scale) {
    rg_pose pose = pose_of(11 + s->count, scale);
    return rg_scene_move_to(s->scene, s->objects[s->count / 3], pose.position);
}

static rg_result move_many(scenario *s, uint32_t scale) {
    double positions[MANY][3];
    for (uint32_t i = 0; i < MANY; i++) memcpy(positions[i], pose_of(i, scale).position, sizeof positions[i]);
    rg_pose_views views = {.size = sizeof views};
    views.position = rg_input3_packed(positions[0], sizeof positions[0], RG_F64);
    rg_input ids = {s->objects, sizeof *s->objects, RG_U64};
    return rg_scene_move_many(s->scene, &ids, &views, MANY);
}

/* A sphere becomes something that is linear, or one again: it is stored otherwise then. */
static rg_result turn_one(scenario *s, uint32_t unused) {
    uint32_t number = (uint32_t)(s->turns * 5 % s->count);
    rg_object_report report = {.size = sizeof report};
    (void)unused;
    if (rg_scene_lookup(s->scene, s->objects[number], &report) != RG_OK) return RG_INVALID_ID;
    rg_pose pose = rg_pose_at(report.pose.position[0], report.pose.position[1], report.pose.position[2] + 1);
    if (s->turns % 2) pose.linear[0] = 3;
    return rg_scene_move(s->scene, s->objects[number], &pose);
}

/* A step so small that it mostly leads nowhere else. */
static rg_result step_one(scenario *s, uint32_t unused) {
    uint32_t number = (uint32_t)(s->turns * 7 % s->count);
    rg_object_report report = {.size = sizeof report};
    (void)unused;
    if (rg_scene_lookup(s->scene, s->objects[number], &report) != RG_OK) return RG_INVALID_ID;
    report.pose.position[s->turns % 3] += 0.1;
    return rg_scene_move_to(s->scene, s->objects[number], report.pose.position);
}

/* More and more come to one place. */
static rg_result crowd_one(scenario *s, uint32_t unused) {
    uint32_t number = (uint32_t)(s->turns * 3 % s->count);
    const double place[3] = {3 + 0.01 * (number % 10), 3, 3 + 0.01 * (number % 7)};
    (void)unused;
    return rg_scene_move_to(s->scene, s->objects[number], place);
}

/* So far away that no float has it. */
static rg_result move_out(scenario *s, uint32_t unused) {
    const double place[3] = {1e90, -1e80, 1e70 * (double)(s->turns + 1)};
    (void)unused;
    return rg_scene_move_to(s->scene, s->objects[s->turns * 11 % s->count], place);
}

/* The shape of the second digit in place of that of the first. */
static rg_result replace_shape(scenario *s, uint32_t shapes) {
    return rg_scene_replace_shape(s->scene, s->shapes[shapes / 10], s->shapes[shapes % 10]);
}

static rg_result set_mask(scenario *s, uint32_t mask) {
    return rg_scene_set_mask(s->scene, s->objects[3], mask);
}

static rg_result remove_one(scenario *s, uint32_t unused) {
    (void)unused;
    rg_result result = rg_scene_remove(s->scene, s->objects[s->count - 1]);
    if (result == RG_OK) s->count--;
    return result;
}

static rg_result remove_many(scenario *s, uint32_t count) {
    rg_input ids = {s->objects + s->count - count, sizeof *s->objects, RG_U64};
    rg_result result = rg_scene_remove_many(s->scene, &ids, count);
    if (result == RG_OK) s->count -= count;
    return result;
}

static rg_result remove_all(scenario *s, uint32_t unused) {
    (void)unused;
    return remove_many(s, s->count);
}

static rg_result make_grid(scenario *s, uint32_t spare) {
    rg_grid_config config = {.size = sizeof config, .kind = s->other, .resolution = 8};
    return rg_grid_create(s->scene, &config, spare ? &s->spare : &s->grid);
}

static rg_result destroy_spare_grid(scenario *s, uint32_t unused) {
    (void)unused;
    return rg_grid_destroy(s->scene, s->spare);
}

enum { SECOND = 16 };

/* The kind, of the second grid with SECOND. */
static rg_result configure(scenario *s, uint32_t which) {
    rg_grid_config config = {.size = sizeof config, .lo = {-9, -9, -9}, .hi = {9, 9, 9}, .resolution = 16};
    config.kind = (rg_grid_kind)(which % SECOND);
    return rg_grid_configure(s->scene, which >= SECOND ? s->grid : RG_GRID_OF_SCENE, &config);
}

static rg_result rebuild(scenario *s, uint32_t second) {
    return rg_grid_rebuild(s->scene, second ? s->grid : RG_GRID_OF_SCENE);
}

static const step STEPS[] = {
    {"create", make_scene, 1, 1, false},
    {"shape", make_shape, BALL, 1, false},
    {"shape", make_shape, CUBE, 1, false},
    {"shape", make_shape, PILL, 1, false},
    {"mesh", make_shape, SOLID, 1, false},
    {"user shape", make_shape, OWN, 1, false},
    {"new vertices", make_shape, BENT, 1, false},
    {"mesh in a hurry", make_shape, HASTY, 1, false},
    {"mesh that borrows", make_shape, LENT, 1, false},
    {"new vertices that it borrows", make_shape, LENT_AGAIN, 1, false},
    {"insert", insert_one, 5, 40, false},
    {"grid", make_grid, 0, 1, false},
    {"grid", make_grid, 1, 1, false},
    {"insert many", insert_many, 0, 1, false},
    {"insert many into the second grid", insert_many, 1, 1, false},
    {"move", move_one, 30, 10, false},
    {"move_to", move_to, 1000, 10, false},
    {"replace a mesh", replace_shape, 10 * SOLID + BENT, 1, false},
    {"replace it again", replace_shape, 10 * BENT + HASTY, 1, false},
    {"replace it by one that borrows", replace_shape, 10 * HASTY + LENT, 1, false},
    {"replace one that borrows", replace_shape, 10 * LENT + LENT_AGAIN, 1, false},
    {"replace balls", replace_shape, 10 * BALL + CUBE, 1, false},
    {"set_mask", set_mask, 5, 1, false},
    {"move many", move_many, 500, 1, false},
    {"rebuild", rebuild, 0, 1, false},
    {"rebuild of the second", rebuild, 1, 1, false},
    {"configure", configure, RG_GRID_UNIFORM, 1, false},
    {"configure the second", configure, SECOND + RG_GRID_HIERARCHICAL, 1, false},
    {"configure the second", configure, SECOND + RG_GRID_LOOSE, 1, false},
    {"configure", configure, RG_GRID_LOOSE, 1, false},
    {"turn", turn_one, 0, 20, false},
    {"step", step_one, 0, 20, true},
    {"crowd", crowd_one, 0, 60, true},
    {"out of all cells", move_out, 0, 12, false},
    {"replace also what has no cell", replace_shape, 10 * CUBE + BALL, 1, false},
    {"replace also what has no cell", replace_shape, 10 * LENT_AGAIN + PILL, 1, false},
    {"and back", move_to, 20, 12, false},
    {"insert far away", insert_one, 100000, 10, false},
    {"move many", move_many, 50, 1, false},
    {"remove", remove_one, 0, 20, false},
    {"remove many", remove_many, MANY, 1, false},
    {"insert after removes", insert_one, 10, 60, false},
    {"configure", configure, RG_GRID_HIERARCHICAL, 1, false},
    {"remove all", remove_all, 0, 1, false},
    {"insert many into the empty second grid", insert_many, 1, 1, false},
    {"configure", configure, RG_GRID_LOOSE, 1, false},
    {"insert many into the empty grid", insert_many, 0, 1, false},
    {"destroy a grid", destroy_spare_grid, 0, 1, false},
};

/* -------------------------------------------------------------------------------------------- the harness */

/* What can be seen of the scene. Tracing must not allocate. */
static void look(scenario *s, probe *p) {
    rg_ray rays[PROBES];
    uint64_t calls = s->memory.calls;
    rg_scene_report report = {.size = sizeof report};
    memset(p, 0, sizeof *p);
    if (!s->scene) return;
    for (int i = 0; i < PROBES; i++) {
        const double from[3] = {60 * cos(i), 60 * sin(i), 40 * cos(1.3 * i)};
        const double to[3] = {-from[0] + i % 5, -from[1] + i % 7, -from[2]};
        rays[i] = rg_ray_from(from, to);
    }
    if (rg_scene_trace(s->scene, rays, p->hits, PROBES) != RG_OK) fail("trace", 0, rg_error_message());
    if (rg_scene_stats(s->scene, &report) != RG_OK) fail("stats", 0, rg_error_message());
    /* A call that failed may have used a slot meanwhile: then its next object has another id there. */
    for (int i = 0; i < PROBES; i++) p->hits[i].object = RG_OBJECT_SLOT(p->hits[i].object);
    p->objects = report.objects;
    p->slots = report.slots;
    p->grids = report.grids;
    if (s->memory.calls != calls) fail("trace", 0, "it allocated");
}

static void finish(scenario *s) {
    if (rg_scene_destroy(&s->scene) != RG_OK) fail("destroy", 0, rg_error_message());
    bool own = s->shapes[OWN] != NULL;
    int lent = (s->shapes[LENT] != NULL) + (s->shapes[LENT_AGAIN] != NULL);
    if (s->given_back) fail("destroy", 0, "data is given back that a shape may still read");
    for (int i = 0; i < SHAPES; i++) rg_shape_release(&s->shapes[i]);
    if (s->own_destroyed != own) fail("release", 0, "the user shape's destroy was not called once");
    if (s->given_back != lent) fail("release", 0, "what was lent was not given back once");
    if (s->memory.live_blocks != 0 || s->memory.live_bytes != 0) fail("destroy", 0, "memory is left");
}

/** Of the scene's own grid and of the second. */
typedef struct kinds {
    rg_grid_kind own, second;
} kinds;

static probe *baseline; /* what is seen after each turn if nothing fails */

static void demand_same(const probe *seen, const probe *want, const step *what, uint32_t turn, const char *why) {
    if (memcmp(seen, want, sizeof *seen) == 0) return;
    fprintf(stderr,
            "objects %" PRIu64 " for %" PRIu64 ", slots %" PRIu64 " for %" PRIu64 ", grids %" PRIu32 " for %" PRIu32
            "\n",
            seen->objects, want->objects, seen->slots, want->slots, seen->grids, want->grids);
    for (int i = 0; i < PROBES; i++) {
        const rg_hit *a = &seen->hits[i], *b = &want->hits[i];
        if (memcmp(a, b, sizeof *a) == 0) continue;
        fprintf(stderr, "ray %d: object %" PRIx64 " t %a, not object %" PRIx64 " t %a\n", i, a->object, a->t,
                b->object, b->t);
    }
    fail(what->name, turn, why);
}

/* One turn: if it fails, nothing may have changed; then memory is there again and it must work. */
static void run_turn(scenario *s, const step *what, uint32_t turn, const probe *before, const probe *after) {
    static probe seen;
    uint64_t failed = s->memory.failed;
    rg_result result = what->run(s, what->argument);
    if (result != RG_OK) {
        if (result != RG_OUT_OF_MEMORY) fail(what->name, turn, rg_result_name(result));
        if (what->needs_none) fail(what->name, turn, "out of memory, but none is needed");
        if (s->memory.failed == failed) fail(what->name, turn, "out of memory, but no allocation failed");
        if (rg_error_message()[0] == 0) fail(what->name, turn, "no message");
        look(s, &seen);
        demand_same(&seen, before, what, turn, "it failed and changed the scene");
        s->memory.fail_at = 0;
        result = what->run(s, what->argument);
        if (result != RG_OK) fail(what->name, turn, "it fails again with memory there");
    }
    look(s, &seen);
    demand_same(&seen, after, what, turn, "the scene is not as without a failure");
    s->turns++;
}

/* Returns the number of allocations. */
static uint64_t run(const kinds *k, uint64_t fail_at, bool ever_after) {
    static scenario s;
    memset(&s, 0, sizeof s);
    s.kind = k->own;
    s.other = k->second;
    s.memory.fail_at = fail_at;
    s.memory.fail_ever_after = ever_after;
    size_t turns = 0;
    for (size_t i = 0; i < sizeof STEPS / sizeof *STEPS; i++) {
        for (uint32_t turn = 0; turn < STEPS[i].repeat; turn++, turns++) {
            run_turn(&s, &STEPS[i], turn, &baseline[turns], &baseline[turns + 1]);
        }
    }
    finish(&s);
    return s.memory.calls;
}

static uint64_t make_baseline(const kinds *k) {
    static scenario s;
    size_t turns = 0, made = 0;
    memset(&s, 0, sizeof s);
    s.kind = k->own;
    s.other = k->second;
    for (size_t i = 0; i < sizeof STEPS / sizeof *STEPS; i++) turns += STEPS[i].repeat;
    baseline = calloc(turns + 1, sizeof *baseline);
    if (!baseline) fail("the test", 0, "out of memory");
    for (size_t i = 0; i < sizeof STEPS / sizeof *STEPS; i++) {
        for (uint32_t turn = 0; turn < STEPS[i].repeat; turn++) {
            rg_result result = STEPS[i].run(&s, STEPS[i].argument);
            if (result != RG_OK) fail(STEPS[i].name, turn, rg_error_message());
            look(&s, &baseline[++made]);
            s.turns++;
        }
    }
    finish(&s);
    return s.memory.calls;
}

int main(void) {
    static const kinds KINDS[] = {
        {RG_GRID_LOOSE, RG_GRID_UNIFORM}, {RG_GRID_HIERARCHICAL, RG_GRID_LOOSE}, {RG_GRID_LOOSE, RG_GRID_LOOSE}};
    for (size_t i = 0; i < sizeof KINDS / sizeof *KINDS; i++) {
        const kinds *k = &KINDS[i];
        uint64_t calls = make_baseline(k);
        printf("kinds %d and %d: %" PRIu64 " allocations, each fails once and once with all after it\n", (int)k->own,
               (int)k->second, calls);
        if (run(k, 0, false) != calls) fail("the test", 0, "the same steps make another number of allocations");
        for (uint64_t n = 1; n <= calls; n++) {
            run(k, n, false);
            run(k, n, true);
        }
        free(baseline);
    }
    return EXIT_SUCCESS;
}
