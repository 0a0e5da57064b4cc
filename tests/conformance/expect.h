/* SPDX-License-Identifier: MIT */
/* Steps that look at the scene instead of changing it. */
#ifndef CONFORMANCE_EXPECT_H
#define CONFORMANCE_EXPECT_H

#include "read.h"

/** Plays a step that expects something; false if it is none of those. */
bool expect_step(context *c, const json_t *step);

#endif
