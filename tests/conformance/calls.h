/* SPDX-License-Identifier: MIT */
/* Steps that call the library. */
#ifndef CONFORMANCE_CALLS_H
#define CONFORMANCE_CALLS_H

#include "read.h"

/**
 * Makes the call that a step describes and gives names to what it made. Returns what the library did, or MALFORMED.
 * `known` tells whether there is such a step.
 */
rg_result call_step(context *c, const json_t *step, bool *known);

#endif
