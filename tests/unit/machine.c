/* SPDX-License-Identifier: MIT */
#include "machine.h"

const rgi_kernels *const machine_kernels[MACHINE_KERNELS] = {
#if defined(__x86_64__)
    &rgi_kernels_avx512, &rgi_kernels_avx2, &rgi_kernels_sse2,
#elif defined(__aarch64__)
    &rgi_kernels_neon,
#endif
    &rgi_kernels_portable};

/* The best is the first that the machine can run; it can run all that follow. */
bool machine_can_run(const rgi_kernels *k) {
    int i = 0;
    while (machine_kernels[i] != rgi_kernels_best()) i++;
    for (; i < MACHINE_KERNELS; i++) {
        if (machine_kernels[i] == k) return true;
    }
    return false;
}

double machine_pick(const double *from, int count) {
    return from[(int)(unit_random() * count)];
}

int machine_below(int n) {
    return (int)(unit_random() * n);
}
