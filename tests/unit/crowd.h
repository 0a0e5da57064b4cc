/* SPDX-License-Identifier: MIT */
/* A lattice for tests, with the truth of what it stores beside it. */
#ifndef RAYGRID_TESTS_CROWD_H
#define RAYGRID_TESTS_CROWD_H

#include "lattice.h"
#include "unit.h"

enum { CROWD_MOST = 40000, CROWDS = 10 };

/** Where a crowd is, and of what sizes. */
typedef struct crowd {
    const char *name;
    double centre, spread;
    double size_from, size_to; /* powers of ten */
    double balls;              /* the part of them that are balls; the others are boxes */
} crowd;

extern const crowd crowds[CROWDS];

/** What is stored, by slot. */
typedef struct crowd_store {
    rgi_memory memory;
    rgi_slots records; /* rgi_object: kernels look at their place and their radius */
    rgi_lattice lattice;
    rgi_bound truth[CROWD_MOST];
    bool stored[CROWD_MOST];
    int blocks_left; /* of memory; negative: as many as are asked for */
} crowd_store;

extern crowd_store store;

void crowd_begin(void);
/** Checks that all memory came back. */
void crowd_end(void);

const rgi_location *crowd_place(uint32_t slot);
void crowd_insert(uint32_t slot, const rgi_bound *bound);

/** Builds the empty lattice from slots whose truth is known. */
rg_result crowd_build(const uint32_t *slots, uint64_t count);

rgi_bound ball_at(double x, double y, double z, double radius);
/** A random box that holds a point, and reaches up to `size` from it on each side. */
rgi_bound box_at(double x, double y, double z, double size);
rgi_bound crowd_bound(const crowd *c);
/** The same somewhere else, up to `by` away on each axis. */
rgi_bound shifted(const rgi_bound *from, double by);

#endif
