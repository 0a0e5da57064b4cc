/* SPDX-License-Identifier: MIT */
#include "bench.h"

#include "gltf.h"

#include <string.h>

static uint32_t body_of_own(const void *side, uint64_t id) {
    return own_body(side, id);
}

static uint32_t body_of_peer(const void *side, uint64_t id) {
    return peer_body(side, id);
}

struct exact_error bench_judge_own(const struct bench_run *run, struct exact_sample *sample, const struct own *own,
                                   const struct bench_answers *answers) {
    if (run->options.spoil) exact_spoil(sample, answers);
    return exact_judge(sample, answers, body_of_own, own, EXACT_PROMISED);
}

struct exact_error bench_judge_peer(struct exact_sample *sample, const struct peer *peer,
                                    const struct bench_answers *answers) {
    return exact_judge(sample, answers, body_of_peer, peer, EXACT_FLOAT);
}

struct bench_scene *bench_scene_of(const struct bench_run *run, const char *scene, uint32_t count) {
#if defined(BENCH_GLTF)
    if (strcmp(scene, BENCH_GLTF_SCENE) == 0) return bench_gltf_scene(run->options.gltf);
#else
    (void)run;
#endif
    return bench_scene_create(scene, count);
}
