/* SPDX-License-Identifier: MIT */
/* verify.h: the rays of a frame against brute force. */
#ifndef DEMO_VERIFY_H
#define DEMO_VERIFY_H

#include "pass.h"
#include "stage.h"

#include <Imath/ImathRandom.h>

namespace demo {

struct Errors {
    size_t checked = 0;
    size_t wrong = 0;
    double worst_t = 0;      /* largest |t - exact t| of a right hit, in world units */
    std::string first_wrong; /* what the first wrong one was; "" if none */
};

/**
 * Judges `count` rays that the pass has traced, chosen at random: one half through pixels, the other to the sun if
 * there are any. The bounds are those that raygrid documents.
 */
Errors verify(const Stage &stage, const Pass &pass, size_t count, Imath::Rand48 &random);

} // namespace demo

#endif
