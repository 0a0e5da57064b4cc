/* SPDX-License-Identifier: MIT */
#ifndef RAYGRID_LIB_THROUGH_H
#define RAYGRID_LIB_THROUGH_H

#include "query.h"

/**
 * Takes the rays `first` to `last` - 1 of a call through all grids, 16 at a time, and writes what is wanted of them.
 * Rays that go the same way go together; others side by side; what is extreme or invalid on its own. Returns the
 * first ray that is left: `last`, or, if it `may_stop` because a change of the scene waits, one after a group of 16.
 */
uint64_t rgi_through(rgi_call *call, uint64_t first, uint64_t last, bool may_stop);

#endif
