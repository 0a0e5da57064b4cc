/* SPDX-License-Identifier: MIT */
/* The one place that knows what the processor can do. */
#include "beam.h"

#ifdef RGI_ISA_VARIABLE
#include <stdlib.h>
#include <string.h>
#endif

/* Those that were built, from the best to the least. */
static const rgi_kernels *const all[] = {
#if defined(__x86_64__) && !defined(RGI_NO_AVX512)
    &rgi_kernels_avx512,
#endif
#if defined(__x86_64__) && !defined(RGI_NO_AVX2)
    &rgi_kernels_avx2,
#endif
#if defined(__x86_64__) && !defined(RGI_NO_SSE2)
    &rgi_kernels_sse2,
#endif
#if defined(__aarch64__) && !defined(RGI_NO_NEON)
    &rgi_kernels_neon,
#endif
    &rgi_kernels_portable};

enum { COUNT = sizeof all / sizeof *all };

static bool can_run(const rgi_kernels *kernels) {
#if defined(__x86_64__)
    __builtin_cpu_init();
    if (kernels->isa == RG_ISA_AVX512)
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
               __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
               __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
    if (kernels->isa == RG_ISA_AVX2)
        return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
#else
    (void)kernels;
#endif
    return true;
}

const rgi_kernels *rgi_kernels_best(void) {
    int i = 0;
#ifdef RGI_ISA_VARIABLE
    /* Test builds only: the best instruction set that may be used, by name. */
    const char *cap = getenv("RAYGRID_ISA");
    while (cap && i < COUNT - 1 && strcmp(all[i]->name, cap) != 0) i++;
#endif
    while (!can_run(all[i])) i++;
    return all[i];
}
