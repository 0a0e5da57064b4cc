/* SPDX-License-Identifier: MIT */
/* What the unit tests share: a runner, and random numbers whose seed is always shown. */
#ifndef RAYGRID_TESTS_UNIT_H
#define RAYGRID_TESTS_UNIT_H

#include <check.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

/** Each test file defines its suite; unit.c runs it. */
Suite *unit_suite(void);

/** An assertion for inner loops: those of Check take a system call each. */
#define MUST(holds)                                                                                                  \
    do {                                                                                                             \
        if (!(holds)) ck_abort_msg("%s", #holds);                                                                    \
    } while (0)

/** A number in [0, 1). */
double unit_random(void);

/** A number in [-1, 1) times 10 to a random power between `from` and `to`. */
double unit_random_scale(double from, double to);

#endif
