/* SPDX-License-Identifier: MIT */
#include "verify.h"

#include <algorithm>

namespace demo {

namespace {

size_t pick(size_t count, Imath::Rand48 &random) {
    return std::min(size_t(random.nextf(0, double(count))), count - 1);
}

void judge_primary(const reference_scene *scene, const Pass &pass, size_t pixel, Errors &errors) {
    const rg_ray ray = pass.primary_ray(pixel);
    const rg_hit hit = pass.primary_hit(pixel);
    reference_error error = {};
    const reference_verdict verdict = reference_compare(scene, &ray, RG_CULL_NONE, &hit, &error);
    ++errors.checked;
    if (verdict == REFERENCE_EQUAL) errors.worst_t = std::max(errors.worst_t, double(error.t));
    if (verdict != REFERENCE_WRONG) return;
    if (errors.wrong++ == 0) errors.first_wrong = "pixel " + std::to_string(pass.place(pixel)) + ": " + error.what;
}

void judge_sun(const reference_scene *scene, const Pass &pass, size_t index, Errors &errors) {
    const rg_ray ray = pass.sun_ray(index);
    const bool hidden = pass.sun.hidden[index] != 0;
    ++errors.checked;
    if (reference_compare_occluded(scene, &ray, RG_CULL_NONE, hidden) != REFERENCE_WRONG) return;
    if (errors.wrong++ == 0)
        errors.first_wrong = "pixel " + std::to_string(pass.place(pass.sun.pixels[index])) +
                             (hidden ? ": its sun is hidden by nothing" : ": its sun is hidden, and that was missed");
}

} // namespace

Errors verify(const Stage &stage, const Pass &pass, size_t count, Imath::Rand48 &random) {
    Errors errors;
    if (!stage.twin()) return errors;
    for (size_t i = 0; i < count; ++i) {
        if (i % 2 == 1 && pass.sun.count > 0)
            judge_sun(stage.twin(), pass, pick(pass.sun.count, random), errors);
        else
            judge_primary(stage.twin(), pass, pick(pass.pixels(), random), errors);
    }
    return errors;
}

} // namespace demo
