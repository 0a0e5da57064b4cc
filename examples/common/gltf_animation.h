/* SPDX-License-Identifier: MIT */
/* gltf_animation.h: animations of node transforms. */
#ifndef DEMO_GLTF_ANIMATION_H
#define DEMO_GLTF_ANIMATION_H

#include "gltf_mesh.h"

#include <Imath/ImathQuat.h>

namespace demo {

/** A node's own transform, in the parts that animations change. */
struct Placement {
    Imath::V3d translation{0, 0, 0};
    Imath::Quatd rotation; /* identity, of length 1 */
    Imath::V3d scale{1, 1, 1};
};

/** How one part of one node's placement changes. */
class Channel {
  public:
    enum class Path { Translation, Rotation, Scale };
    enum class Interpolation { Step, Linear, Cubic };

    /** Throws std::runtime_error; `where` names the channel in it. */
    Channel(const tinygltf::Model &model, const tinygltf::AnimationSampler &sampler, size_t node, Path path,
            const std::string &where);

    size_t node() const { return node_; }
    double end() const { return times_.back(); }

    /** Sets what the channel drives to its value at `time` seconds; before the first key and after the last it rests.
     */
    void apply(double time, Placement &placement) const;

  private:
    Imath::V4d key(size_t index, size_t third) const;
    Imath::V4d at(double time) const;
    Imath::V4d between(size_t index, double share) const;

    size_t node_;
    Path path_;
    Interpolation interpolation_;
    std::vector<double> times_;  /* seconds, rising */
    std::vector<double> values_; /* 3 or 4 numbers a key; with Cubic a tangent before and one after */
};

/** The channels of all animations that move nodes; what else they do goes to `notes`. Throws std::runtime_error. */
std::vector<Channel> read_channels(const tinygltf::Model &model, const Notes &notes);

/** The rotation by a glTF quaternion x, y, z, w, which need not be of length 1. Throws if it has none. */
Imath::Quatd rotation(const Imath::V4d &xyzw);

} // namespace demo

#endif
