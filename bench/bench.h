/* SPDX-License-Identifier: MIT */
/* bench.h: one run of the benchmark: what was asked for, and its sections. */
#ifndef RAYGRID_BENCH_BENCH_H
#define RAYGRID_BENCH_BENCH_H

#include "report.h"
#include "verdict.h"

enum { BENCH_MODELS = 8 };

/** A glTF file that is shown as one mesh. */
struct bench_model {
    const char *file;
    char scene[48]; /* its name: the file's without folders and ending */
};

/** What the command line says. A list of names is separated by commas; NULL: all. */
struct bench_options {
    struct bench_effort effort;
    const char *scenes, *sizes, *sections, *rays, *modes;
    uint32_t largest, largest_other; /* objects: of scenes of spheres, of others */
    struct peer_choice peer;
    const char *embree;        /* auto, none, or the path of its library */
    const char *peer_spheres;  /* how the peer has spheres that stand still: points, user, best */
    const char *peer_mesh;     /* in which qualities it may have a scene's one mesh that stands still */
    const char *embree_config; /* of its device; NULL: nothing special */
    const char *gltf;          /* the file of the scene of that name; NULL: there is none */
    struct bench_model models[BENCH_MODELS];
    int model_count;
    const char *json;
    bool spoil; /* spoil raygrid's answers before they are judged: a test of the judge */
};

/** Fills the options; false if the program is to end, with `status`. */
bool bench_options_read(struct bench_options *options, int argc, char **argv, int *status);

/** Whether a list of the options has that name. */
bool bench_wanted(const char *list, const char *name);

struct bench_run {
    struct bench_options options;
    struct bench_report report;
};

/** How wrong raygrid's answers are, spoilt before if the options say so. */
struct exact_error bench_judge_own(const struct bench_run *run, struct exact_sample *sample, const struct own *own,
                                   const struct bench_answers *answers);

/** The scene that is the glTF file of the options, of whatever size that has. */
#define BENCH_GLTF_SCENE "gltf"

/** The scene of that name, of its own size if it is a file; NULL, after a message, if it can't be had. */
struct bench_scene *bench_scene_of(const struct bench_run *run, const char *scene, uint32_t count);

/* Sections, each for one scene of one size. */
void bench_traces(struct bench_run *run, const char *scene, uint32_t count);
void bench_builds(struct bench_run *run, const char *scene, uint32_t count);
void bench_updates(struct bench_run *run, const char *scene, uint32_t count);
void bench_frames(struct bench_run *run, const char *scene, uint32_t count);
void bench_lasting(struct bench_run *run, const char *scene, uint32_t count);
void bench_threads(struct bench_run *run, const char *scene, uint32_t count);
void bench_omissions(struct bench_run *run, const char *scene, uint32_t count);
void bench_latency(struct bench_run *run, const char *scene, uint32_t count);
void bench_meshes(struct bench_run *run, const char *scene, uint32_t count);

#endif
