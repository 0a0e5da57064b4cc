/* SPDX-License-Identifier: MIT */
#include "meter.h"

#include "median.h"

#include <cstdio>
#include <cstdlib>

namespace viewer {

using demo::median_of;

namespace {

constexpr size_t remembered = 10000, shown = 20;

} // namespace

/* The first frame is not counted: memory is touched for the first time, threads start. */
void Meter::add(const FrameTimes &times) {
    if (begun_) frames_.push_back(times);
    begun_ = true;
    if (frames_.size() > remembered) frames_.pop_front();
}

FrameTimes Meter::recent() const {
    FrameTimes sum;
    const size_t count = std::min(frames_.size(), shown);
    if (count == 0) return sum;
    for (size_t i = frames_.size() - count; i < frames_.size(); ++i) {
        sum.all += frames_[i].all / double(count);
        sum.update += frames_[i].update / double(count);
        sum.primary += frames_[i].primary / double(count);
        sum.sun += frames_[i].sun / double(count);
    }
    return sum;
}

std::string Meter::report(uint32_t width, uint32_t height, uint32_t workers) const {
    if (frames_.empty()) return "";
    double seconds = 0, rays = 0, tracing = 0;
    for (const FrameTimes &frame : frames_) {
        seconds += frame.all;
        rays += double(frame.rays);
        tracing += frame.primary + frame.sun;
    }
    double load[1] = {0};
    getloadavg(load, 1);
    char text[400];
    std::snprintf(
        text, sizeof text,
        "%zu frames of %ux%u, %u workers: %.1f frames/s; median %.2f ms, of which update %.2f, primary rays "
        "%.2f, shadow rays %.2f; %.1f Mrays/s while tracing; %.2f ms of processor time a frame; load average %.2f\n",
        frames_.size(), unsigned(width), unsigned(height), unsigned(workers), double(frames_.size()) / seconds,
        1e3 * median_of(frames_, [](const FrameTimes &frame) { return frame.all; }),
        1e3 * median_of(frames_, [](const FrameTimes &frame) { return frame.update; }),
        1e3 * median_of(frames_, [](const FrameTimes &frame) { return frame.primary; }),
        1e3 * median_of(frames_, [](const FrameTimes &frame) { return frame.sun; }),
        1e-6 * rays / std::max(tracing, 1e-9),
        1e3 * median_of(frames_, [](const FrameTimes &frame) { return frame.processor; }), load[0]);
    return text;
}

} // namespace viewer
