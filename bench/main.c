/* SPDX-License-Identifier: MIT */
/* main.c: runs the sections that were asked for on the scenes that were asked for. */
#include "bench.h"

#include <stdlib.h>
#include <string.h>

enum { SMALLEST = 100, LARGEST = 1000000 }; /* objects */

/* Kinds of scenes. */
enum { SPHERES = 1, OBJECTS = 2, ONE_MESH = 4 };

/* What is done with one scene of one size. */
struct section {
    const char *name;
    void (*run)(struct bench_run *run, const char *scene, uint32_t count);
    int scenes; /* the kinds that it is for */
};

static const struct section SECTIONS[] = {
    {"builds", bench_builds, SPHERES | OBJECTS},
    {"traces", bench_traces, SPHERES | OBJECTS | ONE_MESH},
    {"meshes", bench_meshes, ONE_MESH},
    {"updates", bench_updates, SPHERES | OBJECTS},
    {"frames", bench_frames, SPHERES | OBJECTS | ONE_MESH},
    {"lasting", bench_lasting, SPHERES},
    {"threads", bench_threads, SPHERES},
    {"omissions", bench_omissions, SPHERES},
    {"latency", bench_latency, SPHERES},
};

static bool is_named(const char *scene, const char *const names[]) {
    for (int i = 0; names[i]; i++) {
        if (strcmp(scene, names[i]) == 0) return true;
    }
    return false;
}

static int kind_of(const char *scene) {
    static const char *const spheres[] = {"uniform", "mixed", "stadium", NULL};
    static const char *const meshes[] = {"noisy", "soup", NULL};
    return is_named(scene, spheres) ? SPHERES : is_named(scene, meshes) ? ONE_MESH : OBJECTS;
}

/* The scenes that are as large as they are. */
static void run_on_files(struct bench_run *run, const struct section *section) {
    const struct bench_options *options = &run->options;
    if (options->sizes) return;
    if ((section->scenes & OBJECTS) && options->gltf && bench_wanted(options->scenes, BENCH_GLTF_SCENE))
        section->run(run, BENCH_GLTF_SCENE, 0);
    for (int i = 0; (section->scenes & ONE_MESH) && i < options->model_count; i++) {
        const char *scene = options->models[i].scene;
        if (bench_wanted(options->scenes, scene)) section->run(run, scene, 0);
    }
}

static void run_section(struct bench_run *run, const struct section *section) {
    const struct bench_options *options = &run->options;
    for (int s = 0; BENCH_SCENES[s]; s++) {
        const char *scene = BENCH_SCENES[s];
        int kind = kind_of(scene);
        if (!bench_wanted(options->scenes, scene) || !(section->scenes & kind)) continue;
        uint32_t largest = kind == OBJECTS ? options->largest_other : options->largest;
        /* Unasked the smallest size is that of instances alone: other scenes have no goals there. */
        uint32_t smallest = strcmp(scene, "meshes") == 0 ? SMALLEST : 10 * SMALLEST;
        for (uint32_t count = SMALLEST; count <= LARGEST; count *= 10) {
            char size[16];
            snprintf(size, sizeof size, "%u", count);
            if (options->sizes ? bench_wanted(options->sizes, size) : count >= smallest && count <= largest)
                section->run(run, scene, count);
        }
    }
}

static void name_versions(struct bench_report *report, const struct embree_api *api) {
    report->versions = bench_versions_of(api);
    const struct bench_versions *v = &report->versions;
    printf("raygrid %s (instructions: %s), %s; peer: %s\n", v->own, v->isa, v->compiler, api ? v->peer : "none");
}

int main(int argc, char **argv) {
    struct bench_run run = {0};
    int status;
    if (!bench_options_read(&run.options, argc, argv, &status)) return status;
    struct embree_api *api = NULL;
    if (strcmp(run.options.embree, "none") != 0) {
        api = embree_open(run.options.embree, run.options.embree_config);
        if (!api && strcmp(run.options.embree, "auto") != 0) return 2;
    }
    run.options.peer.api = api;
    if (run.options.json && !(run.report.json = fopen(run.options.json, "w"))) {
        perror(run.options.json);
        return 2;
    }
    name_versions(&run.report, api);
    for (size_t i = 0; i < sizeof SECTIONS / sizeof *SECTIONS; i++) {
        if (!bench_wanted(run.options.sections, SECTIONS[i].name)) continue;
        run_section(&run, &SECTIONS[i]);
        run_on_files(&run, &SECTIONS[i]);
    }
    bench_report_end(&run.report);
    bool unwritten = run.report.json && fclose(run.report.json) != 0;
    if (unwritten) perror(run.options.json);
    embree_close(api);
    return unwritten || run.report.wrong ? 1 : 0;
}
