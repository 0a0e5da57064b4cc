/* SPDX-License-Identifier: MIT */
/* versions.h: who takes part, for those who read the figures later. */
#ifndef RAYGRID_BENCH_VERSIONS_H
#define RAYGRID_BENCH_VERSIONS_H

#include "embree_api.h"

struct bench_versions {
    char own[64], peer[64], compiler[64]; /* peer: empty if there is none */
    const char *isa;                      /* the instructions that raygrid's kernels use here */
};

/** `api` NULL: there is no peer. */
struct bench_versions bench_versions_of(const struct embree_api *api);

#endif
