/* SPDX-License-Identifier: MIT */
/* shade.h: light, from what a pass has found; all in linear light of the sRGB primaries. */
#ifndef DEMO_SHADE_H
#define DEMO_SHADE_H

#include "look.h"
#include "pass.h"

namespace demo {

/** What a camera sees through one pixel of a pass. */
Imath::V3f shade(const Looks &looks, const Pass &pass, size_t pixel);

} // namespace demo

#endif
