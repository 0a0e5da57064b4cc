/* SPDX-License-Identifier: MIT */
/* The rays that are held against brute force are spread over a picture, few as they may be. */
#include "exact.h"

#include <stdio.h>
#include <stdlib.h>

enum { SIDE = 512, FEW = 64 };

/* What spoiling changes is what is judged. */
static uint32_t find_judged(const struct bench_answers *answers, uint32_t count, uint32_t *judged) {
    uint32_t found = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (answers->t[i] != 8 || answers->id[i] != 0) judged[found++] = i;
    }
    return found;
}

/* How many of the values at those places there are, each counted once. */
static uint32_t count_different(const float *values, const uint32_t *places, uint32_t count) {
    uint32_t different = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t j = 0;
        while (values[places[j]] != values[places[i]]) j++;
        different += j == i;
    }
    return different;
}

int main(void) {
    struct bench_scene *bodies = bench_scene_create("noisy", 1000);
    struct bench_rays *rays = bench_primary_rays(bodies, SIDE, false);
    struct bench_answers answers = bench_answers_create(rays->count);
    struct exact *exact = exact_create(bodies, NULL);
    struct exact_sample *sample = exact_sample_create(exact, rays, 0);
    uint32_t *judged = bench_allocate(rays->count, sizeof *judged);
    for (uint32_t i = 0; i < rays->count; i++) answers.t[i] = 8;
    exact_spoil(sample, &answers);
    uint32_t count = find_judged(&answers, rays->count, judged), hits = 0;
    for (uint32_t i = 0; i < count; i++) hits += answers.t[judged[i]] != 1;
    uint32_t columns = count_different(rays->direction[0], judged, count);
    uint32_t rows = count_different(rays->direction[1], judged, count);
    printf("%u rays judged, %u of them hits, in %u columns and %u rows\n", count, hits, columns, rows);
    free(judged);
    exact_sample_destroy(sample);
    exact_destroy(exact);
    bench_answers_destroy(&answers);
    bench_rays_destroy(rays);
    bench_scene_destroy(bodies);
    return count == FEW && hits >= FEW / 8 && columns >= FEW / 2 && rows >= FEW / 2 ? 0 : 1;
}
