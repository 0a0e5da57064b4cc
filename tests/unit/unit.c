/* SPDX-License-Identifier: MIT */
#include "unit.h"

#include <stdio.h>

static uint64_t state;

/* G. Marsaglia, "Xorshift RNGs" (2003), with a multiplication. */
static uint64_t next(void) {
    state ^= state >> 12;
    state ^= state << 25;
    state ^= state >> 27;
    return state * 0x2545f4914f6cdd1du;
}

double unit_random(void) {
    return (double)(next() >> 11) * 0x1p-53;
}

double unit_random_scale(double from, double to) {
    return (2 * unit_random() - 1) * pow(10, from + (to - from) * unit_random());
}

int main(int argc, char **argv) {
    state = argc > 1 ? strtoull(argv[1], NULL, 10) : 20001;
    printf("seed %llu\n", (unsigned long long)state);
    SRunner *runner = srunner_create(unit_suite());
    srunner_set_fork_status(runner, CK_NOFORK);
    srunner_run_all(runner, CK_NORMAL);
    int failed = srunner_ntests_failed(runner);
    int ran = srunner_ntests_run(runner);
    srunner_free(runner);
    return failed || !ran;
}
