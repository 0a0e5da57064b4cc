/* SPDX-License-Identifier: MIT */
#include "swarm.h"

#include <Imath/ImathMatrix.h>
#include <algorithm>
#include <cmath>

namespace demo {

namespace {

constexpr double clearance = 1.1;       /* of the model, which lies within a radius of 1 */
constexpr double share_replaced = 0.02; /* of the swarm, each frame */

} // namespace

void set_linear(rg_pose &pose, const Imath::Quatd &turn, const Imath::V3d &stretch) {
    pose.scale = 1;
    const Imath::M33d rows = turn.toMatrix33(); /* for row vectors: its rows are our columns */
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            pose.linear[3 * row + column] = float(rows[column][row] * stretch[column]);
}

Swarm::Swarm(Stage &stage, bool boxes, size_t count, double floor, uint64_t seed)
    : stage_(stage), boxes_(boxes), count_(count), floor_(floor),
      random_(static_cast<unsigned long>(seed * 2 + boxes)) {
    if (count == 0) return;
    const double corner[3] = {1, 1, 1}, opposite[3] = {-1, -1, -1};
    if (boxes) forms_.push_back(stage.box(opposite, corner));
    /* A shape for each size, rather than one under scaling poses: then the poses only shift, the cheapest kind. */
    for (int i = 0; !boxes && i < 8; ++i) forms_.push_back(stage.sphere(0.013 * std::pow(1.19, i)));
}

/* Most drift outward in a flat belt around the model, so that they don't hide it; one in ten goes up or down. */
void Swarm::add(bool anywhere) {
    const double turn = random_.nextf(0, 2 * M_PI);
    const double out = anywhere ? clearance + (stage_hi[0] - clearance) * std::sqrt(random_.nextf()) : clearance;
    const double speed = random_.nextf(0.3, 2.5);
    const bool upright = random_.nextf() < 0.1;
    const Imath::V3d outward(std::cos(turn), 0, std::sin(turn));
    Imath::V3d place = outward * out;
    place.y = floor_ + 0.05 + 0.55 * random_.nextf() * random_.nextf();

    Motion motion;
    motion.velocity = outward * (upright ? 0.3 * speed : speed) + Imath::V3d(-outward.z, 0, outward.x) * 0.5;
    motion.velocity.y = upright ? random_.nextf(-0.8, 1.6) : random_.nextf(-0.05, 0.15);
    motion.axis = Imath::hollowSphereRand<Imath::V3d>(random_);
    motion.rate = random_.nextf(-4, 4);
    motion.angle = random_.nextf(0, 2 * M_PI);
    const double size = 0.013 * std::exp(random_.nextf(0, 1.1));
    motion.stretch =
        boxes_ ? Imath::V3d(size, size * random_.nextf(0.4, 1.6), size * random_.nextf(0.4, 1.6)) : Imath::V3d(1);
    Body body;
    for (int axis = 0; axis < 3; ++axis) body.pose.position[axis] = place[axis];
    body.form = forms_[std::min(size_t(random_.nextf(0, double(forms_.size()))), forms_.size() - 1)];
    set_linear(body.pose, boxes_ ? Imath::Quatd().setAxisAngle(motion.axis, motion.angle) : Imath::Quatd(),
               motion.stretch);
    bodies_.push_back(body);
    motions_.push_back(motion);
}

void Swarm::start() {
    while (bodies_.size() < count_) add(true);
    stage_.insert(bodies_.data(), bodies_.size());
    fresh_ = bodies_.size();
}

Swarm::Change Swarm::advance(double seconds) {
    fresh_ = size_t(std::ceil(double(count_) * share_replaced));
    const size_t kept = count_ - fresh_;
    /* Those that go are swapped to the end, so that the rest stays one array for the views. */
    for (size_t last = count_; last-- > kept;) {
        const size_t chosen = std::min(size_t(random_.nextf(0, double(last + 1))), last);
        std::swap(bodies_[chosen], bodies_[last]);
        std::swap(motions_[chosen], motions_[last]);
    }
    stage_.remove(bodies_.data() + kept, fresh_);
    bodies_.resize(kept);
    motions_.resize(kept);

    for (size_t i = 0; i < kept; ++i) {
        Motion &motion = motions_[i];
        for (int axis = 0; axis < 3; ++axis) bodies_[i].pose.position[axis] += motion.velocity[axis] * seconds;
        motion.angle += motion.rate * seconds;
        if (boxes_)
            set_linear(bodies_[i].pose, Imath::Quatd().setAxisAngle(motion.axis, motion.angle), motion.stretch);
    }
    stage_.move(bodies_.data(), kept, boxes_);

    while (bodies_.size() < count_) add(false);
    stage_.insert(bodies_.data() + kept, fresh_);
    return {fresh_, fresh_};
}

} // namespace demo
