/* SPDX-License-Identifier: MIT */
/*
 * raygrid-replay: plays a recording of a scene, or looks into a snapshot.
 *
 *   raygrid-replay [options] file
 *     --until N                 stops after N calls
 *     --list                    prints each call
 *     --ray OX OY OZ DX DY DZ   traces a ray in the end; may be given several times
 *     --save FILE               writes a snapshot of the scene in the end
 *     --workers N               threads that trace together; 1 if not given
 *
 * A user-defined shape is the host's code, which is not here: the box that holds it stands in for it, and the output
 * says so. Exit status: 0 all was played, 1 the file is damaged or cut off (what was whole has been played), 2 usage.
 */
#define _GNU_SOURCE /* getopt_long */

#include <raygrid/raygrid.h>

#include <getopt.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_RAYS = 64, CALLS = RG_CALL_REPLACE_SHAPE + 1 };

typedef struct options {
    const char *file, *save;
    uint64_t until;
    rg_ray rays[MOST_RAYS];
    int ray_count;
    uint32_t workers;
    int list;
} options;

static void usage(void) {
    fprintf(stderr, "usage: raygrid-replay [--until N] [--list] [--ray OX OY OZ DX DY DZ]... [--save FILE]\n"
                    "                      [--workers N] file\n");
    exit(2);
}

static void demand(rg_result result, const char *what) {
    if (result == RG_OK) return;
    fprintf(stderr, "raygrid-replay: %s: %s: %s\n", what, rg_result_name(result), rg_error_message());
    exit(1);
}

/* -------------------------------------------------------------------------------------------------- options */

static double number_of(const char *text) {
    char *end;
    double number = text ? strtod(text, &end) : 0;
    if (!text || end == text || *end) usage();
    return number;
}

/* A ray's six numbers: the option's own and the five arguments behind it, negative ones among them. */
static void read_ray(options *o, char **argv, int argc) {
    double numbers[6];
    if (o->ray_count == MOST_RAYS) usage();
    for (int i = 0; i < 6; i++) {
        const int at = optind - 1 + i;
        numbers[i] = number_of(at < argc ? argv[at] : NULL);
    }
    optind += 5;
    o->rays[o->ray_count++] = rg_ray_from(numbers, numbers + 3);
}

static options read_options(int argc, char **argv) {
    static const struct option LONG[] = {
        {"until", required_argument, NULL, 'u'},   {"list", no_argument, NULL, 'l'},
        {"ray", required_argument, NULL, 'r'},     {"save", required_argument, NULL, 's'},
        {"workers", required_argument, NULL, 'w'}, {NULL, 0, NULL, 0}};
    options o = {.until = UINT64_MAX, .workers = 1};
    int option;
    /* "+": in the order given, so that what follows --ray is its own. */
    while ((option = getopt_long(argc, argv, "+", LONG, NULL)) != -1) {
        if (option == 'u')
            o.until = (uint64_t)number_of(optarg);
        else if (option == 'l')
            o.list = 1;
        else if (option == 'r')
            read_ray(&o, argv, argc);
        else if (option == 's')
            o.save = optarg;
        else if (option == 'w')
            o.workers = (uint32_t)number_of(optarg);
        else
            usage();
    }
    if (optind != argc - 1) usage();
    o.file = argv[optind];
    return o;
}

/* ------------------------------------------------------------------------------------------- bytes in and out */

static unsigned char *read_file(const char *path, uint64_t *size) {
    FILE *file = strcmp(path, "-") == 0 ? stdin : fopen(path, "rb");
    size_t room = 1 << 16, got;
    unsigned char *bytes = malloc(room);
    *size = 0;
    while (file && bytes && (got = fread(bytes + *size, 1, room - *size, file)) > 0) {
        *size += got;
        if (*size < room) continue;
        unsigned char *more = realloc(bytes, room *= 2);
        if (!more) free(bytes);
        bytes = more;
    }
    if (!file || !bytes || ferror(file)) {
        perror(path);
        exit(2);
    }
    if (file != stdin) fclose(file);
    return bytes;
}

static int32_t write_file(void *user, const void *bytes, size_t size) {
    return fwrite(bytes, 1, size, user) == size ? 0 : -1;
}

/* FNV-1a, 64 bits (draft-eastlake-fnv, section 2): tells one state of a scene from another. */
static int32_t hash_bytes(void *user, const void *bytes, size_t size) {
    uint64_t *hash = user;
    for (size_t i = 0; i < size; i++) *hash = (*hash ^ ((const unsigned char *)bytes)[i]) * UINT64_C(0x100000001b3);
    return 0;
}

/* ------------------------------------------------------------------------------------- stand-ins for the host */

/* What stands in for a user-defined shape: a scene that has its box. */
typedef struct stand_in {
    uint64_t number;
    rg_scene *scene;
} stand_in;

static int32_t intersect(void *user, const rg_local_ray *ray, rg_local_hit *hit) {
    const stand_in *s = user;
    rg_ray own = rg_ray_from(ray->origin, ray->direction);
    rg_hit found;
    own.t_min = ray->t_min;
    own.t_max = ray->t_max;
    if (rg_scene_trace(s->scene, &own, &found, 1) != RG_OK) return -1;
    if (found.object == RG_NO_OBJECT) return 0;
    memset(hit, 0, sizeof *hit);
    hit->t = found.t;
    hit->primitive = found.primitive;
    for (int i = 0; i < 3; i++) hit->normal[i] = found.normal[i];
    return 1;
}

static void destroy(void *user) {
    stand_in *s = user;
    rg_scene_destroy(&s->scene);
    free(s);
}

static rg_result make_stand_in(stand_in *s, const double lo[3], const double hi[3], rg_shape **shape) {
    const rg_scene_config config = {.size = sizeof config, .workers = 1};
    rg_user_shape definition = {.size = sizeof definition, .user = s, .intersect = intersect, .destroy = destroy};
    rg_shape *box = NULL;
    memcpy(definition.lo, lo, sizeof definition.lo);
    memcpy(definition.hi, hi, sizeof definition.hi);
    rg_result result = rg_shape_create_box(NULL, lo, hi, &box);
    if (!result) result = rg_scene_create(&config, &s->scene);
    if (!result) result = rg_scene_insert(s->scene, box, NULL, NULL);
    if (!result) result = rg_shape_create_user(NULL, &definition, shape);
    rg_shape_release(&box);
    return result;
}

static int32_t find_shape(void *user, uint64_t number, const double lo[3], const double hi[3], rg_shape **shape) {
    stand_in *s = calloc(1, sizeof *s);
    if (!s) return 1;
    s->number = number;
    ++*(uint64_t *)user;
    if (make_stand_in(s, lo, hi, shape) == RG_OK) return 0;
    destroy(s);
    return 1;
}

static int32_t number_shape(void *user, const rg_shape *shape, void *shape_user, uint64_t *number) {
    (void)user, (void)shape;
    *number = ((const stand_in *)shape_user)->number;
    return 0;
}

/* ------------------------------------------------------------------------------------------------ what it does */

/* Plays, and counts the calls of each kind. Returns what ended it. */
static rg_result play(rg_replay *replay, const options *o, rg_replay_report *report, uint64_t calls[CALLS]) {
    rg_result result = RG_OK;
    do {
        uint64_t from = report->offset;
        if (report->calls == o->until) break;
        result = rg_replay_step(replay, report);
        if (result || report->call == RG_CALL_NONE) break;
        calls[report->call]++;
        if (!o->list) continue;
        printf("%8" PRIu64 "  byte %9" PRIu64 "  %s", report->calls, from, rg_call_name(report->call));
        if (report->object) printf(" object 0x%" PRIx64, report->object);
        if (report->objects > 1) printf(" and %" PRIu64 " more", report->objects - 1);
        if (report->grid) printf(" grid 0x%" PRIx32, report->grid);
        printf("\n");
    } while (1);
    return result;
}

static void trace(rg_scene *scene, const rg_ray *ray) {
    rg_hit hit;
    demand(rg_scene_trace(scene, ray, &hit, 1), "tracing a ray");
    printf("ray (%.17g, %.17g, %.17g) to (%.17g, %.17g, %.17g): ", ray->origin[0], ray->origin[1], ray->origin[2],
           ray->direction[0], ray->direction[1], ray->direction[2]);
    if (hit.object == RG_NO_OBJECT)
        printf("%s\n", hit.t == hit.t ? "no hit" : "invalid");
    else
        printf("object 0x%" PRIx64 " primitive %" PRIu32 " t %.17g normal (%.9g, %.9g, %.9g)\n", hit.object,
               hit.primitive, hit.t, hit.normal[0], hit.normal[1], hit.normal[2]);
}

static void summarise(rg_scene *scene, const uint64_t calls[CALLS], uint64_t played) {
    uint64_t hash = UINT64_C(0xcbf29ce484222325);
    const rg_sink sink = {.size = sizeof sink, .user = &hash, .write = hash_bytes, .number_shape = number_shape};
    rg_scene_report report = {.size = sizeof report};
    printf("%" PRIu64 " calls played\n", played);
    for (rg_call call = 1; call < CALLS; call++) {
        if (calls[call]) printf("%8" PRIu64 "  %s\n", calls[call], rg_call_name(call));
    }
    demand(rg_scene_stats(scene, &report), "rg_scene_stats");
    demand(rg_scene_save(scene, &sink), "the hash of the scene");
    printf("%" PRIu64 " objects, %" PRIu64 " slots, %" PRIu32 " grids\n", report.objects, report.slots, report.grids);
    printf("state %016" PRIx64 "\n", hash);
}

static void save(rg_scene *scene, const char *path) {
    FILE *file = fopen(path, "wb");
    const rg_sink sink = {.size = sizeof sink, .user = file, .write = write_file, .number_shape = number_shape};
    if (!file) {
        perror(path);
        exit(2);
    }
    demand(rg_scene_save(scene, &sink), path);
    if (fclose(file) != 0) {
        perror(path);
        exit(2);
    }
}

int main(int argc, char **argv) {
    const options o = read_options(argc, argv);
    uint64_t calls[CALLS] = {0}, size, stand_ins = 0;
    unsigned char *bytes = read_file(o.file, &size);
    const rg_scene_config config = {.size = sizeof config, .workers = o.workers};
    const rg_source source = {
        .size = sizeof source, .bytes = bytes, .byte_count = size, .user = &stand_ins, .find_shape = find_shape};
    rg_replay_report report = {.size = sizeof report};
    rg_replay *replay;
    rg_scene *scene;
    demand(rg_replay_create(&config, &source, &replay, &scene), o.file);
    rg_result result = play(replay, &o, &report, calls);
    if (result) printf("it ends here: %s: %s\n", rg_result_name(result), rg_error_message());
    summarise(scene, calls, report.calls);
    if (stand_ins) printf("%" PRIu64 " user-defined shapes: boxes stand in for them\n", stand_ins);
    for (int i = 0; i < o.ray_count; i++) trace(scene, &o.rays[i]);
    if (o.save) save(scene, o.save);
    rg_replay_destroy(&replay);
    rg_scene_destroy(&scene);
    free(bytes);
    return result ? 1 : 0;
}
