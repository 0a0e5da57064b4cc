/* SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 200809L
#include "bench.h"
#include "gltf.h"

#include <getopt.h>
#include <stdlib.h>
#include <string.h>

static const struct bench_effort FULL = {
    .turns = 5,
    .turn_seconds = 0.02,
    .side = 512,
    .incoherent = 65536,
    .checks = 4e8,
    .touched = 100000,
    .churn = 10000000,
    .calls = 1000000,
    .frames = 100,
    .shares = 4,
};

static const struct bench_effort QUICK = {
    .turns = 5,
    .turn_seconds = 0.004,
    .side = 256,
    .incoherent = 8192,
    .checks = 1e7,
    .touched = 10000,
    .churn = 100000,
    .calls = 100000,
    .frames = 10,
    .shares = 2,
};

/* So little that all sections run in seconds; the figures mean nothing. */
static const struct bench_effort SELFTEST = {
    .turns = 1,
    .turn_seconds = 0,
    .side = 32,
    .incoherent = 512,
    .checks = 1e6,
    .touched = 100,
    .churn = 1000,
    .calls = 400,
    .frames = 1,
    .shares = 4,
};

static const char USAGE[] =
    "usage: bench [OPTIONS]\n"
    "Measures raygrid, and Embree in the same run if it is there, and how wrong the answers of both are.\n"
    "  --quick               fewer rays, 10^3 and 10^4 objects: about a minute\n"
    "  --json FILE           also writes each line of figures as a JSON object\n"
    "What is measured (lists are separated by commas):\n"
    "  --scene LIST          uniform, mixed, stadium, boxes, capsules, mixture, meshes, gltf; and of one\n"
    "                        mesh: noisy, soup, and models by their names\n"
    "  --size LIST           numbers of objects, of one mesh triangles, such as 1000,100000\n"
    "  --only LIST           sections: builds, traces, meshes (building one, and new vertices for it), updates,\n"
    "                        frames, lasting, threads, omissions (up to 10000 objects unless sizes are given),\n"
    "                        latency; the last two of the scene uniform\n"
    "  --rays LIST           of traces: primary, shadow, random, random any, each also with 'aimed ' before it\n"
    "  --mode LIST           of traces, rays a call: 1, 16, batch; of latency, grids: loose, hierarchical, uniform\n"
    "  --gltf FILE           what the scene gltf shows, each part a mesh; its size is its own\n"
    "  --model FILE          a glTF file shown as one mesh, the scene of its name, as bunny of bunny.glb; up to 7\n"
    "                        times; the engine that the demo shows is always there\n"
    "The peer:\n"
    "  --embree WHAT         auto (what the system has; the default), none, or the path of libembree3 or 4\n"
    "  --embree-config TEXT  handed to its rtcNewDevice, such as isa=avx2\n"
    "  --robust              its robust mode\n"
    "  --peer-spheres WHAT   of traces: points (its own sphere points; the default), user (user-defined geometry "
    "with\n"
    "                        vectorised callbacks: faster for packets of coherent rays), best (of both)\n"
    "  --peer-mesh LIST      of traces of one mesh: medium (the default), high, low; of some the best\n"
    "Tests of the benchmark itself:\n"
    "  --selftest            as little as possible\n"
    "  --spoil               makes raygrid's answers wrong before they are judged: the columns must say so\n"
    "Ends with 1 if any answer of raygrid was wrong.\n";

enum {
    QUICK_RUN = 256,
    JSON,
    SCENE,
    SIZE,
    ONLY,
    RAYS,
    MODE,
    GLTF,
    MODEL,
    EMBREE,
    EMBREE_CONFIG,
    PEER_SPHERES_AS,
    PEER_MESH_AS,
    ROBUST,
    SELFTEST_RUN,
    SPOIL,
    HELP
};

static const struct option LONG[] = {
    {"quick", no_argument, NULL, QUICK_RUN},
    {"json", required_argument, NULL, JSON},
    {"scene", required_argument, NULL, SCENE},
    {"size", required_argument, NULL, SIZE},
    {"only", required_argument, NULL, ONLY},
    {"rays", required_argument, NULL, RAYS},
    {"mode", required_argument, NULL, MODE},
    {"embree", required_argument, NULL, EMBREE},
    {"gltf", required_argument, NULL, GLTF},
    {"model", required_argument, NULL, MODEL},
    {"peer-spheres", required_argument, NULL, PEER_SPHERES_AS},
    {"peer-mesh", required_argument, NULL, PEER_MESH_AS},
    {"robust", no_argument, NULL, ROBUST},
    {"embree-config", required_argument, NULL, EMBREE_CONFIG},
    {"selftest", no_argument, NULL, SELFTEST_RUN},
    {"spoil", no_argument, NULL, SPOIL},
    {"help", no_argument, NULL, HELP},
    {NULL, 0, NULL, 0},
};

static void shorten(struct bench_options *options, const struct bench_effort *effort, uint32_t largest) {
    options->effort = *effort;
    options->largest = options->largest_other = largest;
}

static bool is_scene(const struct bench_options *options, const char *name) {
    for (int s = 0; BENCH_SCENES[s]; s++) {
        if (strcmp(name, BENCH_SCENES[s]) == 0) return true;
    }
    for (int i = 0; i < options->model_count; i++) {
        if (strcmp(name, options->models[i].scene) == 0) return true;
    }
    return strcmp(name, BENCH_GLTF_SCENE) == 0;
}

/* False, after a message, if there can be no scene of that name beside the others. */
static bool add_model(struct bench_options *options, const char *file) {
    if (options->model_count == BENCH_MODELS) {
        fprintf(stderr, "more than %d models\n", BENCH_MODELS);
        return false;
    }
    struct bench_model *model = &options->models[options->model_count];
    const char *slash = strrchr(file, '/'), *base = slash ? slash + 1 : file, *dot = strrchr(base, '.');
    int length = (int)(dot ? dot - base : (long)strlen(base));
    model->file = file;
    snprintf(model->scene, sizeof model->scene, "%.*s", length, base);
    if (is_scene(options, model->scene)) {
        fprintf(stderr, "%s: there is a scene '%s' already\n", file, model->scene);
        return false;
    }
    options->model_count++;
    return true;
}

static bool read_one(struct bench_options *options, int option) {
#if !defined(BENCH_GLTF)
    if (option == GLTF || option == MODEL) {
        fputs("built without glTF\n", stderr);
        return false;
    }
#endif
    switch (option) {
    case QUICK_RUN:
        shorten(options, &QUICK, 10000);
        return true;
    case SELFTEST_RUN:
        shorten(options, &SELFTEST, 1000);
        return true;
    case JSON:
        options->json = optarg;
        return true;
    case SCENE:
        options->scenes = optarg;
        return true;
    case SIZE:
        options->sizes = optarg;
        return true;
    case ONLY:
        options->sections = optarg;
        return true;
    case RAYS:
        options->rays = optarg;
        return true;
    case MODE:
        options->modes = optarg;
        return true;
    case GLTF:
        options->gltf = optarg;
        return true;
    case MODEL:
        return add_model(options, optarg);
    case EMBREE:
        options->embree = optarg;
        return true;
    case EMBREE_CONFIG:
        options->embree_config = optarg;
        return true;
    case PEER_SPHERES_AS:
        options->peer_spheres = optarg;
        return strcmp(optarg, "points") == 0 || strcmp(optarg, "user") == 0 || strcmp(optarg, "best") == 0;
    case PEER_MESH_AS:
        options->peer_mesh = optarg;
        return bench_wanted(optarg, "medium") || bench_wanted(optarg, "high") || bench_wanted(optarg, "low");
    case ROBUST:
        options->peer.robust = true;
        return true;
    case SPOIL:
        options->spoil = true;
        return true;
    default:
        return false;
    }
}

bool bench_options_read(struct bench_options *options, int argc, char **argv, int *status) {
    memset(options, 0, sizeof *options);
    options->effort = FULL;
    options->largest = 1000000;
    options->largest_other = 100000;
    options->embree = "auto";
    options->peer_spheres = "points";
    options->peer_mesh = PEER_BUILD_NAMES[PEER_MEDIUM];
#if defined(BENCH_GLTF)
    options->gltf = bench_gltf_usual();
    add_model(options, options->gltf);
#endif
    int option;
    while ((option = getopt_long(argc, argv, "", LONG, NULL)) != -1) {
        if (read_one(options, option)) continue;
        fputs(USAGE, option == HELP ? stdout : stderr);
        *status = option == HELP ? 0 : 2;
        return false;
    }
    if (optind < argc) {
        fprintf(stderr, "what is '%s'?\n%s", argv[optind], USAGE);
        *status = 2;
        return false;
    }
    return true;
}

bool bench_wanted(const char *list, const char *name) {
    if (!list) return true;
    size_t length = strlen(name);
    for (const char *at = list; at; at = strchr(at, ',')) {
        if (*at == ',') at++;
        if (strncmp(at, name, length) == 0 && (at[length] == 0 || at[length] == ',')) return true;
    }
    return false;
}
