/* SPDX-License-Identifier: MIT */
/* The kernels that there are for this kind of machine, and what tests of them share. */
#ifndef RAYGRID_TESTS_MACHINE_H
#define RAYGRID_TESTS_MACHINE_H

#include "beam.h"
#include "unit.h"

#if defined(__x86_64__)
enum { MACHINE_KERNELS = 4 };
#elif defined(__aarch64__)
enum { MACHINE_KERNELS = 2 };
#else
enum { MACHINE_KERNELS = 1 };
#endif

/** From the best to the least. */
extern const rgi_kernels *const machine_kernels[MACHINE_KERNELS];

bool machine_can_run(const rgi_kernels *kernels);

/** One of `count` numbers. */
double machine_pick(const double *from, int count);

/** In [0, n). */
int machine_below(int n);

#endif
