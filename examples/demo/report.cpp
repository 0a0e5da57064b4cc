/* SPDX-License-Identifier: MIT */
#include "report.h"

#include "median.h"
#include "text.h"

#include <cinttypes>
#include <cstdio>
#include <unistd.h>

namespace demo {

namespace {

double rays_per_second(const Frame &frame) {
    const double seconds = frame.cost.primary + frame.cost.shadow;
    return double(frame.cost.primary_rays + frame.cost.shadow_rays) / std::max(seconds, 1e-9);
}

const char header[] = "frame objects    in   out  update ms  primary ms  shadow ms  Mrays/s  rebuilds  tiles  checked"
                      "  wrong  worst t error\n";

} // namespace

Report::Report(const Options &options) : options_(options), terminal_(isatty(STDERR_FILENO) != 0) {}

void Report::note(const std::string &text) {
    clear_bar();
    std::fprintf(stderr, "raygrid-demo: note: %s\n", one_line(text).c_str());
}

void Report::clear_bar() {
    if (terminal_ && !options_.quiet) std::fputs("\r\033[K", stderr);
}

void Report::draw_bar() {
    if (!terminal_ || options_.quiet) return;
    constexpr size_t width = 40;
    const size_t done = width * frames_.size() / options_.frames;
    const std::string bar = std::string(done, '#') + std::string(width - done, '.');
    std::fprintf(stderr, "[%s] %zu of %" PRIu32 " frames", bar.c_str(), frames_.size(), options_.frames);
    std::fflush(stderr);
}

void Report::add(const Frame &frame) {
    clear_bar();
    if (!options_.quiet) {
        if (frames_.empty()) std::fputs(header, stdout);
        std::printf(
            "%5zu %7" PRIu64 " %5zu %5zu %10.3f %11.2f %10.2f %8.2f %9" PRIu64 " %6" PRIu64 " %8zu %6zu  %13.2g\n",
            frames_.size(), frame.objects, frame.update.inserted, frame.update.removed, 1e3 * frame.update.seconds,
            1e3 * frame.cost.primary, 1e3 * frame.cost.shadow, 1e-6 * rays_per_second(frame), frame.rebuilds,
            frame.tiles, frame.errors.checked, frame.errors.wrong, frame.errors.worst_t);
        std::fflush(stdout);
    }
    if (frame.errors.wrong > 0)
        std::fprintf(stderr, "raygrid-demo: frame %zu: %s\n", frames_.size(), frame.errors.first_wrong.c_str());
    wrong_ += frame.errors.wrong;
    frames_.push_back(frame);
    draw_bar();
}

void Report::finish(const std::string &out) {
    clear_bar();
    if (frames_.empty()) return;
    /* The first frame inserts everything, so it is no measure of a change. */
    const std::vector<Frame> changes(frames_.begin() + (frames_.size() > 1), frames_.end());
    size_t checked = 0;
    double worst = 0;
    for (const Frame &frame : frames_) {
        checked += frame.errors.checked;
        worst = std::max(worst, frame.errors.worst_t);
    }
    std::printf("\nmedians of %zu frames of %" PRIu32 "x%" PRIu32 ", %" PRIu32 " sample(s) a pixel: update %.3f ms, "
                "primary %.2f ms, shadow %.2f ms, primary %.2f Mrays/s, all %.2f Mrays/s\n",
                frames_.size(), options_.width, options_.height, options_.samples,
                1e3 * median_of(changes, [](const Frame &frame) { return frame.update.seconds; }),
                1e3 * median_of(frames_, [](const Frame &frame) { return frame.cost.primary; }),
                1e3 * median_of(frames_, [](const Frame &frame) { return frame.cost.shadow; }),
                1e-6 * median_of(frames_,
                                 [](const Frame &frame) {
                                     return double(frame.cost.primary_rays) / std::max(frame.cost.primary, 1e-9);
                                 }),
                1e-6 * median_of(frames_, rays_per_second));
    std::printf("against brute force: %zu rays checked, %zu wrong hits, worst t error %.2g\n", checked, wrong_,
                worst);
    std::printf("pictures: %s\n", out.c_str());
}

} // namespace demo
