/* SPDX-License-Identifier: MIT */
#include "bench.h"

#include "gltf.h"

#include <string.h>

struct exact_error bench_judge_own(const struct bench_run *run, struct exact_sample *sample, const struct own *own,
                                   const struct bench_answers *answers) {
    if (run->options.spoil) exact_spoil(sample, answers);
    return verdict_of_own(sample, own, answers);
}

struct bench_scene *bench_scene_of(const struct bench_run *run, const char *scene, uint32_t count) {
#if defined(BENCH_GLTF)
    if (strcmp(scene, BENCH_GLTF_SCENE) == 0) return bench_gltf_scene(run->options.gltf);
    for (int i = 0; i < run->options.model_count; i++) {
        const struct bench_model *model = &run->options.models[i];
        if (strcmp(scene, model->scene) == 0) return bench_gltf_mesh(model->file, model->scene);
    }
#else
    (void)run;
#endif
    return bench_scene_create(scene, count);
}
