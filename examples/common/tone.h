/* SPDX-License-Identifier: MIT */
/* tone.h: from light to what a screen shows. */
#ifndef DEMO_TONE_H
#define DEMO_TONE_H

#include <Imath/ImathVec.h>
#include <algorithm>

namespace demo {

/** Compresses light to the range 0 to 1 of a screen, still linear: Narkowicz's fit of the ACES curve. */
inline Imath::V3f tone_map(const Imath::V3f &light) {
    Imath::V3f shown;
    for (int c = 0; c < 3; ++c) {
        const float x = std::max(light[c], 0.0f) * 0.62f;
        shown[c] = std::clamp(x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f), 0.0f, 1.0f);
    }
    return shown;
}

} // namespace demo

#endif
