/* SPDX-License-Identifier: MIT */
/*
 * concurrency: some threads trace while others insert, move and remove. Made for the thread sanitizer, but it also
 * judges every hit.
 *
 * Each object has a lane along x of its own, and the ray of that lane meets nothing else. A "runner" jumps between
 * two places, so its ray must find it at the one or the other, never nowhere. Runners come in pairs that are moved in
 * one call: what sees the scene at one instant, a call of up to 16 rays and each 16 of a longer one, must see both
 * before or both after. A "blinker" comes and goes under new ids.
 */
#include <raygrid/raygrid.h>

#include <inttypes.h>
#include <math.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PAIRS = 8, BLINKERS = 8, TRACERS = 2, RAYS = 1024, LANES = 2 * PAIRS + BLINKERS };

/* Where runners jump between, x; so far apart that cells, tiles and the logical box change. */
static const double NEAR = 10, FAR = 900, FROM = -100;

typedef struct shared {
    rg_scene *scene;
    rg_shape *ball;
    rg_object runners[PAIRS][2];
    rg_grid_kind kind; /* of its grid, at first */
    int rounds;
    pthread_mutex_t lock;
    int movers_left, traces, failures;
} shared;

static double lane_y(int lane) {
    return 5.0 * lane;
}

/* Rays go lane by lane, or so many in each lane together: neighbours may be traced in another way. */
enum { TOGETHER = 12 };

/* So many rays of a call, from its first on, see the scene at one instant. */
enum { INSTANT = 16 };

static int lane_of(int ray, bool together) {
    return (together ? ray / TOGETHER : ray) % LANES;
}

static void complain(shared *s, const char *what, double t) {
    pthread_mutex_lock(&s->lock);
    if (s->failures++ < 10) fprintf(stderr, "FAILED: %s, t = %a; message: %s\n", what, t, rg_error_message());
    pthread_mutex_unlock(&s->lock);
}

static bool more_to_come(shared *s) {
    pthread_mutex_lock(&s->lock);
    bool more = s->movers_left > 0;
    pthread_mutex_unlock(&s->lock);
    return more;
}

static void count_trace(shared *s) {
    pthread_mutex_lock(&s->lock);
    s->traces++;
    pthread_mutex_unlock(&s->lock);
}

/* So many rounds at the least, and until there were as many traces beside them. */
static bool goes_on(shared *s, int round) {
    pthread_mutex_lock(&s->lock);
    bool more = round < s->rounds || s->traces < s->rounds;
    pthread_mutex_unlock(&s->lock);
    return more;
}

static void mover_done(shared *s) {
    pthread_mutex_lock(&s->lock);
    s->movers_left--;
    pthread_mutex_unlock(&s->lock);
}

/* Another kind of grid each time. */
static void configure(shared *s, int time) {
    const rg_grid_config grid = {.size = sizeof grid, .kind = 1 + (s->kind + time) % 3};
    if (rg_grid_configure(s->scene, RG_GRID_OF_SCENE, &grid) != RG_OK) complain(s, "configure", 0);
}

static void *move_runners(void *argument) {
    shared *s = argument;
    for (int round = 0; goes_on(s, round); round++) {
        for (int pair = 0; pair < PAIRS; pair++) {
            double position[2][3] = {{0}};
            for (int k = 0; k < 2; k++) {
                position[k][0] = round % 2 ? NEAR : FAR;
                position[k][1] = lane_y(2 * pair + k);
            }
            rg_input ids = {s->runners[pair], sizeof(rg_object), RG_U64};
            rg_pose_views poses = {.size = sizeof poses};
            poses.position = rg_input3_packed(position[0], sizeof position[0], RG_F64);
            if (rg_scene_move_many(s->scene, &ids, &poses, 2) != RG_OK) complain(s, "move_many", 0);
        }
        if (round % 8 == 7) configure(s, round / 8);
        if (round % 16 == 0 && rg_grid_rebuild(s->scene, RG_GRID_OF_SCENE) != RG_OK) complain(s, "rebuild", 0);
    }
    mover_done(s);
    return NULL;
}

static void *blink(void *argument) {
    shared *s = argument;
    rg_object ids[BLINKERS] = {0};
    for (int round = 0; goes_on(s, round); round++) {
        for (int i = 0; i < BLINKERS; i++) {
            rg_pose pose = rg_pose_at(round % 3 ? NEAR : FAR, lane_y(2 * PAIRS + i), 0);
            if (rg_scene_insert(s->scene, s->ball, &pose, &ids[i]) != RG_OK) complain(s, "insert", 0);
        }
        for (int i = 0; i < BLINKERS; i++) {
            const double position[3] = {FAR, lane_y(2 * PAIRS + i), 0};
            if (rg_scene_move_to(s->scene, ids[i], position) != RG_OK) complain(s, "move_to", 0);
            if (rg_scene_set_mask(s->scene, ids[i], 3) != RG_OK) complain(s, "set_mask", 0);
            if (rg_scene_remove(s->scene, ids[i]) != RG_OK) complain(s, "remove", 0);
            if (rg_scene_remove(s->scene, ids[i]) != RG_INVALID_ID) complain(s, "a stale id", 0);
        }
    }
    mover_done(s);
    return NULL;
}

static bool at(double t, double x) {
    return fabs(t - (x - 1 - FROM)) <= 0x1p-39;
}

static void judge(shared *s, const rg_hit *hits, bool together) {
    for (int i = 0; i < RAYS; i++) {
        int lane = lane_of(i, together), partner = i + 1;
        const rg_hit *h = &hits[i];
        bool runner = lane < 2 * PAIRS, near = at(h->t, NEAR), far = at(h->t, FAR);
        if (!runner && h->object == RG_NO_OBJECT) continue;
        if (!near && !far) complain(s, "an object where none ever was, or none where one must be", h->t);
        if (runner && h->object != s->runners[lane / 2][lane % 2]) complain(s, "another object", h->t);
        if (partner % INSTANT == 0 || partner == RAYS || !runner) continue;
        int next = lane_of(partner, together);
        if (next / 2 == lane / 2 && h->t != hits[partner].t)
            complain(s, next == lane ? "16 rays saw two states of a runner" : "a pair was seen half moved", h->t);
    }
}

static void *trace(void *argument) {
    shared *s = argument;
    rg_ray *rays = calloc(RAYS, sizeof *rays);
    rg_hit *hits = calloc(RAYS, sizeof *hits);
    uint8_t *occluded = calloc(RAYS, 1);
    if (!rays || !hits || !occluded) exit(EXIT_FAILURE);
    for (bool together = false; more_to_come(s); together = !together) {
        for (int i = 0; i < RAYS; i++) {
            const double origin[3] = {FROM, lane_y(lane_of(i, together)), 0}, direction[3] = {1, 0, 0};
            rays[i] = rg_ray_from(origin, direction);
        }
        if (rg_scene_trace(s->scene, rays, hits, RAYS) != RG_OK) complain(s, "trace", 0);
        judge(s, hits, together);
        count_trace(s);
        if (rg_scene_occluded(s->scene, rays, occluded, RAYS) != RG_OK) complain(s, "occluded", 0);
        for (int i = 0; i < RAYS; i++) {
            if (lane_of(i, together) < 2 * PAIRS && occluded[i] != 1) complain(s, "occluded missed a runner", 0);
        }
        rg_scene_report report = {.size = sizeof report};
        if (rg_scene_stats(s->scene, &report) != RG_OK) complain(s, "stats", 0);
        if (report.objects < 2 * PAIRS || report.objects > LANES) complain(s, "number of objects", 0);
    }
    free(rays);
    free(hits);
    free(occluded);
    return NULL;
}

static void start(pthread_t *thread, void *(*run)(void *), shared *s) {
    if (pthread_create(thread, NULL, run, s) != 0) exit(EXIT_FAILURE);
}

static void run(shared *s, rg_grid_kind kind, uint32_t workers) {
    const rg_grid_config grid = {.size = sizeof grid, .kind = kind};
    const rg_scene_config config = {.size = sizeof config, .workers = workers, .grid = &grid};
    pthread_t tracers[TRACERS], movers[2];
    if (rg_scene_create(&config, &s->scene) != RG_OK) exit(EXIT_FAILURE);
    for (int lane = 0; lane < 2 * PAIRS; lane++) {
        rg_pose pose = rg_pose_at(NEAR, lane_y(lane), 0);
        if (rg_scene_insert(s->scene, s->ball, &pose, &s->runners[lane / 2][lane % 2]) != RG_OK) exit(EXIT_FAILURE);
    }
    s->kind = kind;
    s->traces = 0;
    s->movers_left = 2;
    for (int i = 0; i < TRACERS; i++) start(&tracers[i], trace, s);
    start(&movers[0], move_runners, s);
    start(&movers[1], blink, s);
    for (int i = 0; i < 2; i++) pthread_join(movers[i], NULL);
    for (int i = 0; i < TRACERS; i++) pthread_join(tracers[i], NULL);
    if (rg_scene_destroy(&s->scene) != RG_OK) complain(s, "destroy", 0);
    printf("kind %d: %d traces\n", (int)kind, s->traces);
}

int main(int argc, char **argv) {
    shared s = {.rounds = argc > 1 ? atoi(argv[1]) : 40, .lock = PTHREAD_MUTEX_INITIALIZER};
    if (rg_shape_create_sphere(NULL, 1, &s.ball) != RG_OK) return EXIT_FAILURE;
    run(&s, RG_GRID_UNIFORM, 2);
    run(&s, RG_GRID_HIERARCHICAL, 2);
    run(&s, RG_GRID_LOOSE, 2);
    run(&s, RG_GRID_LOOSE, 1);
    rg_shape_release(&s.ball);
    printf("%d failures\n", s.failures);
    return s.failures ? EXIT_FAILURE : EXIT_SUCCESS;
}
