/* SPDX-License-Identifier: MIT */
#include "acts.h"

#include <algorithm>
#include <cmath>

namespace viewer {

using namespace demo;
using Imath::V3d;

namespace {

constexpr double period = 16; /* seconds from whole to apart to whole */

/* 0 when all is together, 1 when it is farthest apart. */
double apartness(double time) {
    return 0.5 - 0.5 * std::cos(2 * M_PI * time / period);
}

/* Two directions at right angles to an axis of length 1 and to each other. */
void complete(const V3d &axis, V3d &side, V3d &other) {
    const V3d away = std::fabs(axis.x) < 0.6 ? V3d(1, 0, 0) : V3d(0, 1, 0);
    side = axis.cross(away).normalized();
    other = axis.cross(side);
}

V3d random_in_cube(Imath::Rand48 &random) {
    const double x = random.nextf(-1, 1), y = random.nextf(-1, 1); /* drawn one after another, on every compiler */
    return {x, y, random.nextf(-1, 1)};
}

} // namespace

/* ------------------------------------------------------------------------------------------------- balls */

void Balls::add(double radius, const Motion &motion) {
    Body body;
    body.form = form_;
    body.pose = rg_pose_at(motion.home.x, motion.home.y, motion.home.z);
    body.pose.scale = radius;
    bodies_.push_back(body);
    motions_.push_back(motion);
}

void Balls::advance(double time, Looks &looks) {
    for (size_t i = 0; i < bodies_.size(); ++i) {
        const V3d at = place(motions_[i], time);
        std::copy_n(&at.x, 3, bodies_[i].pose.position);
    }
    if (inserted_) {
        stage_.move(bodies_.data(), bodies_.size(), false);
        return;
    }
    stage_.insert(bodies_.data(), bodies_.size());
    for (const Body &body : bodies_) looks.set(body.object, look_by_id(body.object));
    inserted_ = true;
}

/* The last one takes its place, so that the rest stays one array for the views. */
bool Balls::release(rg_object object) {
    const auto found =
        std::find_if(bodies_.begin(), bodies_.end(), [object](const Body &body) { return body.object == object; });
    if (found == bodies_.end()) return false;
    motions_[size_t(found - bodies_.begin())] = motions_.back();
    *found = bodies_.back();
    motions_.pop_back();
    bodies_.pop_back();
    return true;
}

/* ------------------------------------------------------------------------------------------------- flake */

Flake::Flake(Stage &stage, uint32_t generations, double floor, uint64_t seed)
    : Balls(stage), floor_(floor), random_(static_cast<unsigned long>(seed)) {
    grow(V3d(0), 0.5, V3d(0, 1, 0), V3d(0), generations);
}

/* Six around the waist and three towards the pole, as the axis has it; the side that it grew out of is left free. */
void Flake::grow(const V3d &centre, double radius, const V3d &axis, const V3d &drift, uint32_t generations) {
    const V3d turning = random_in_cube(random_) * radius;
    Motion motion = {centre, drift, turning, random_.nextf(0, 2 * M_PI)};
    /* None ends below the floor. */
    motion.a.y = std::max(drift.y, floor_ + radius - centre.y + std::fabs(turning.y));
    add(radius, motion);
    if (generations == 0) return;
    V3d side, other;
    complete(axis, side, other);
    for (int i = 0; i < 9; ++i) {
        const double around = i < 6 ? i * M_PI / 3 : (i - 6) * 2 * M_PI / 3 + M_PI / 6;
        const double up = i < 6 ? 0 : 0.95; /* radians */
        const V3d out = (side * std::cos(around) + other * std::sin(around)) * std::cos(up) + axis * std::sin(up);
        const double far = radius * random_.nextf(1.2, 4.5);
        grow(centre + out * (radius * 4 / 3), radius / 3, out, drift + out * far, generations - 1);
    }
}

V3d Flake::place(const Motion &motion, double time) const {
    const double far = apartness(time);
    return motion.home + motion.a * far + motion.b * (far * std::sin(time + motion.phase));
}

/* ------------------------------------------------------------------------------------------------- field */

Field::Field(Stage &stage, Looks &looks, uint32_t count, double share, uint64_t seed) : Balls(stage) {
    Imath::Rand48 random(static_cast<unsigned long>(seed));
    const double radius = std::cbrt(0.05 * 8 / (count * 4.0 / 3 * M_PI));
    const uint32_t moving = uint32_t(std::lround(count * share));
    const Form form = stage.sphere(1);
    std::vector<Body> resting;
    for (uint32_t i = 0; i < count; ++i) {
        const V3d home = random_in_cube(random);
        if (i < moving) {
            const V3d axis = Imath::hollowSphereRand<V3d>(random);
            Motion motion = {home, V3d(0), V3d(0), random.nextf(0, 2 * M_PI)};
            complete(axis, motion.a, motion.b);
            motion.a *= 4 * radius, motion.b *= 4 * radius;
            add(radius, motion);
        } else {
            Body body;
            body.pose = rg_pose_at(home.x, home.y, home.z);
            body.pose.scale = radius;
            body.form = form;
            resting.push_back(body);
        }
    }
    stage.insert(resting.data(), resting.size());
    for (const Body &body : resting) looks.set(body.object, look_by_id(body.object));
}

V3d Field::place(const Motion &motion, double time) const {
    const double turn = motion.phase + 5 * time;
    return motion.home + motion.a * std::cos(turn) + motion.b * std::sin(turn);
}

/* ------------------------------------------------------------------------------------------------ engine */

Engine::Engine(Stage &stage, const std::string &path, uint64_t seed, const Notes &notes)
    : notes_(notes), model_(path, notes), parts_(model_, stage, seed) {}

void Engine::advance(double time, Looks &looks) {
    parts_.advance(std::fmod(time, period) / period, notes_);
    parts_.paint(looks);
}

} // namespace viewer
