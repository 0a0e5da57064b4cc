/* SPDX-License-Identifier: MIT */
/* median.h: the middle of what was measured in many frames. */
#ifndef DEMO_MEDIAN_H
#define DEMO_MEDIAN_H

#include <algorithm>
#include <vector>

namespace demo {

/** The median of value(frame) over frames, of which there is at least one. */
template <typename Frames, typename Value> double median_of(const Frames &frames, Value value) {
    std::vector<double> values;
    for (const auto &frame : frames) values.push_back(value(frame));
    std::sort(values.begin(), values.end());
    const size_t half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

} // namespace demo

#endif
