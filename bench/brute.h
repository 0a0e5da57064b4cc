/* SPDX-License-Identifier: MIT */
/* brute.h: the shapes of a scene as those of tests/reference. */
#ifndef RAYGRID_BENCH_BRUTE_H
#define RAYGRID_BENCH_BRUTE_H

#include "scenes.h"

#include <reference.h>

const reference_shape *brute_shape(reference_scene *reference, const struct bench_shape *shape);

#endif
