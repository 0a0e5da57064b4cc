/* SPDX-License-Identifier: MIT */
#include "parts.h"

#include <Imath/ImathBoxAlgo.h>
#include <Imath/ImathRandom.h>
#include <algorithm>
#include <cmath>

namespace demo {

namespace {

/* Row vectors to column vectors: the transpose. */
void set_pose(rg_pose &pose, const Imath::M44d &matrix) {
    pose.scale = 1;
    for (int row = 0; row < 3; ++row) {
        pose.position[row] = matrix[3][row];
        for (int column = 0; column < 3; ++column) pose.linear[3 * row + column] = float(matrix[column][row]);
    }
}

/* raygrid wants more than 2^-40 of the product of the lengths of the rows; this leaves room for rounding. */
bool is_invertible(const rg_pose &pose) {
    Imath::V3d row[3];
    for (int i = 0; i < 3; ++i)
        row[i] = Imath::V3d(pose.linear[3 * i], pose.linear[3 * i + 1], pose.linear[3 * i + 2]);
    const double determinant = row[0].dot(row[1].cross(row[2]));
    return std::fabs(determinant) > 1e-9 * row[0].length() * row[1].length() * row[2].length();
}

Imath::Box3d local_box(const Surface &surface) {
    Imath::Box3d box;
    for (size_t i = 0; i + 2 < surface.vertices.size(); i += 3)
        box.extendBy(Imath::V3d(surface.vertices[i], surface.vertices[i + 1], surface.vertices[i + 2]));
    return box;
}

double smooth(double x) {
    x = std::min(std::max(x, 0.0), 1.0);
    return x * x * (3 - 2 * x);
}

} // namespace

Parts::Parts(const Model &model, Stage &stage, uint64_t seed) : model_(model), stage_(stage) {
    std::vector<Form> forms;
    std::vector<Imath::Box3d> locals;
    for (size_t s = 0; s < model.surfaces().size(); ++s) {
        const Surface &surface = model.surfaces()[s];
        try {
            forms.push_back(stage.mesh(surface.vertices, surface.corners));
        } catch (const std::exception &error) {
            throw std::runtime_error(surface.name + ": " + error.what());
        }
        locals.push_back(local_box(surface));
    }
    const std::vector<Imath::M44d> transforms = model.transforms(0);
    std::vector<Imath::Box3d> boxes(transforms.size()); /* of each node's parts */
    Imath::Box3d whole;
    for (const Model::Part &part : model.parts()) {
        boxes[part.node].extendBy(Imath::transform(locals[part.surface], transforms[part.node]));
        whole.extendBy(boxes[part.node]);
        Body body;
        body.form = forms[part.surface];
        bodies_.push_back(body);
    }
    told_.assign(bodies_.size(), false);
    released_.assign(bodies_.size(), false);

    const double radius = (whole.max - whole.min).length() / 2;
    if (!(radius > 0 && radius < 1e30)) throw std::runtime_error("has no extent, or one beyond all measure");
    const Imath::V3d centre = whole.center();
    Imath::M44d shift, scale;
    shift.setTranslation(-centre);
    scale.setScale(1 / radius);
    to_stage_ = shift * scale;
    floor_ = (whole.min.y - centre.y) / radius;
    for (Imath::Box3d &box : boxes)
        if (!box.isEmpty()) box = Imath::transform(box, to_stage_);
    plan(boxes, seed);
}

/* Every part flies away from the middle, the farther the farther out it lies, but never below the floor. */
void Parts::plan(const std::vector<Imath::Box3d> &boxes, uint64_t seed) {
    Imath::Rand48 random(static_cast<unsigned long>(seed + 1000));
    for (const Imath::Box3d &box : boxes) {
        Flight flight = {};
        if (!box.isEmpty()) {
            flight.centre = box.center();
            const double out = flight.centre.length();
            const Imath::V3d direction = out > 1e-6 ? flight.centre / out : Imath::V3d(0, 1, 0);
            flight.away = direction * (0.25 + 0.55 * out) + Imath::V3d(0, 0.4 + random.nextf(0, 0.5), 0);
            const double radius = (box.max - box.min).length() / 2;
            const double lowest = floor_ + radius - flight.centre.y; /* it turns, so its box is no measure */
            flight.away.y = std::max(flight.away.y, lowest);
            flight.delay = 1 - std::min(out, 1.0);
        }
        flight.axis = Imath::hollowSphereRand<Imath::V3d>(random);
        flight.turn = random.nextf(0.6, 2.4);
        flights_.push_back(flight);
    }
}

/* Out in the first half, back in the second; in between all rest for a moment. */
Imath::M44d Parts::flight(size_t node, double phase) const {
    const Flight &flight = flights_[node];
    const double there = 1 - std::fabs(2 * phase - 1); /* 0, 1, 0 */
    const double far = smooth((there - 0.3 * flight.delay) / 0.62);
    Imath::M44d to_origin, turn, back;
    to_origin.setTranslation(-flight.centre);
    turn.setAxisAngle(flight.axis, flight.turn * far);
    back.setTranslation(flight.centre + flight.away * far);
    return to_origin * turn * back;
}

Parts::Change Parts::advance(double phase, const Notes &notes) {
    const std::vector<Imath::M44d> transforms = model_.transforms(phase * model_.duration());
    std::vector<bool> present(bodies_.size());
    for (size_t i = 0; i < bodies_.size(); ++i) {
        if (released_[i]) continue;
        const Model::Part &part = model_.parts()[i];
        set_pose(bodies_[i].pose, transforms[part.node] * to_stage_ * flight(part.node, phase));
        present[i] = is_invertible(bodies_[i].pose);
        if (present[i] || told_[i]) continue;
        notes(part.name + ": its transform can't be inverted, so it is not shown while that lasts");
        told_[i] = true;
    }
    return update_presence(present);
}

Parts::Change Parts::update_presence(const std::vector<bool> &present) {
    Change change = {0, 0};
    /* Runs of parts that have the same thing done to them go in one call: nearly always one run of all. */
    enum class Deed { Nothing, Insert, Move, Remove };
    const auto deed = [&](size_t i) {
        if (released_[i]) return Deed::Nothing;
        const bool there = bodies_[i].object != RG_NO_OBJECT;
        if (!there) return present[i] ? Deed::Insert : Deed::Nothing;
        return present[i] ? Deed::Move : Deed::Remove;
    };
    for (size_t first = 0, end = 0; first < bodies_.size(); first = end) {
        const Deed done = deed(first);
        for (end = first; end < bodies_.size() && deed(end) == done; ++end) continue;
        Body *bodies = &bodies_[first];
        const size_t count = end - first;
        if (done == Deed::Insert) stage_.insert(bodies, count), change.inserted += count;
        if (done == Deed::Move) stage_.move(bodies, count, true);
        if (done == Deed::Remove) {
            stage_.remove(bodies, count), change.removed += count;
            for (size_t i = first; i < end; ++i) bodies_[i].object = RG_NO_OBJECT;
        }
    }
    return change;
}

Look Parts::look_of(size_t part) const {
    const Surface &surface = model_.surfaces()[model_.parts()[part].surface];
    Look look;
    look.colour = surface.colour;
    look.gloss = std::max(surface.gloss, 0.35f);
    look.surface = surface.normals.empty() ? nullptr : &surface;
    const float *m = bodies_[part].pose.linear;
    /* For row vectors a normal goes by the inverse of the linear part for column vectors. */
    look.normals = Imath::M33f(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8]).inverse();
    return look;
}

void Parts::paint(Looks &looks) const {
    for (size_t i = 0; i < bodies_.size(); ++i)
        if (!released_[i] && bodies_[i].object != RG_NO_OBJECT) looks.set(bodies_[i].object, look_of(i));
}

bool Parts::release(rg_object object) {
    for (size_t i = 0; i < bodies_.size(); ++i) {
        if (released_[i] || bodies_[i].object != object) continue;
        released_[i] = true;
        return true;
    }
    return false;
}

} // namespace demo
