/* SPDX-License-Identifier: MIT */
#include "versions.h"

#include "own.h"

#include <stdio.h>

struct bench_versions bench_versions_of(const struct embree_api *api) {
    static const char *const ISAS[] = {"portable", "sse2", "avx2", "avx512", "neon"};
    struct bench_versions v = {.peer = ""};
    uint32_t version = rg_version();
    snprintf(v.own, sizeof v.own, "%u.%u.%u", version / 1000000, version / 1000 % 1000, version % 1000);
    snprintf(v.compiler, sizeof v.compiler, "%s",
#if defined(__clang__)
             "clang " __clang_version__
#else
             "gcc " __VERSION__
#endif
    );
    if (api) {
        snprintf(v.peer, sizeof v.peer, "Embree %d.%d.%d", api->version / 10000, api->version / 100 % 100,
                 api->version % 100);
    }
    rg_scene_report report = {.size = sizeof report};
    rg_scene *scene;
    own_check(rg_scene_create(NULL, &scene));
    own_check(rg_scene_stats(scene, &report));
    own_check(rg_scene_destroy(&scene));
    v.isa = ISAS[report.isa];
    return v;
}
