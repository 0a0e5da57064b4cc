/* SPDX-License-Identifier: MIT */
#include "gltf_animation.h"

#include "gltf_accessor.h"

#include <algorithm>
#include <cmath>

namespace demo {

namespace {

Channel::Interpolation interpolation(const std::string &name, const std::string &where) {
    if (name == "STEP") return Channel::Interpolation::Step;
    if (name == "LINEAR") return Channel::Interpolation::Linear;
    if (name == "CUBICSPLINE") return Channel::Interpolation::Cubic;
    throw std::runtime_error(where + " has the interpolation '" + name + "', which glTF 2 has not");
}

size_t components(Channel::Path path) {
    return path == Channel::Path::Rotation ? 4 : 3;
}

bool finite(const std::vector<double> &numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](double number) { return std::isfinite(number); });
}

} // namespace

Imath::Quatd rotation(const Imath::V4d &xyzw) {
    Imath::Quatd quaternion(xyzw.w, xyzw.x, xyzw.y, xyzw.z);
    const double length = quaternion.length();
    if (!(length > 1e-9 && std::isfinite(length)))
        throw std::runtime_error("a rotation is a quaternion of no length");
    quaternion /= length;
    return quaternion;
}

Channel::Channel(const tinygltf::Model &model, const tinygltf::AnimationSampler &sampler, size_t node, Path path,
                 const std::string &where)
    : node_(node), path_(path), interpolation_(interpolation(sampler.interpolation, where)),
      times_(read_accessor(model, sampler.input, 1)),
      values_(read_accessor(model, sampler.output, int(components(path)))) {
    const size_t per_key = components(path) * (interpolation_ == Interpolation::Cubic ? 3 : 1);
    if (values_.size() != times_.size() * per_key)
        throw std::runtime_error(where + " has " + std::to_string(times_.size()) + " keys but " +
                                 std::to_string(values_.size() / components(path)) + " values");
    const auto not_later = [](double a, double b) { return !(a < b); };
    if (!finite(times_) || std::adjacent_find(times_.begin(), times_.end(), not_later) != times_.end())
        throw std::runtime_error(where + " has key times that do not rise");
    if (!finite(values_)) throw std::runtime_error(where + " has a value that is not finite");
    if (path == Path::Rotation)
        for (size_t i = 0; i < times_.size(); ++i) rotation(key(i, 1));
}

/* With Cubic, a key has three parts: the tangent before (0), the value (1), the tangent after (2). */
Imath::V4d Channel::key(size_t index, size_t third) const {
    const size_t width = components(path_);
    const size_t row = interpolation_ == Interpolation::Cubic ? 3 * index + third : index;
    const double *from = &values_[row * width];
    return Imath::V4d(from[0], from[1], from[2], width == 4 ? from[3] : 0);
}

Imath::V4d Channel::between(size_t index, double share) const {
    const Imath::V4d here = key(index, 1), next = key(index + 1, 1);
    if (interpolation_ == Interpolation::Step) return here;
    if (interpolation_ == Interpolation::Cubic) {
        /* Hermite's basis; tangents are per second, hence the length of the interval. */
        const double s = share, s2 = s * s, s3 = s2 * s, seconds = times_[index + 1] - times_[index];
        return here * (2 * s3 - 3 * s2 + 1) + key(index, 2) * ((s3 - 2 * s2 + s) * seconds) +
               next * (3 * s2 - 2 * s3) + key(index + 1, 0) * ((s3 - s2) * seconds);
    }
    if (path_ != Path::Rotation) return here + (next - here) * share;
    const Imath::Quatd turned = Imath::slerpShortestArc(rotation(here), rotation(next), share);
    return Imath::V4d(turned.v.x, turned.v.y, turned.v.z, turned.r);
}

Imath::V4d Channel::at(double time) const {
    if (time <= times_.front()) return key(0, 1);
    if (time >= times_.back()) return key(times_.size() - 1, 1);
    const size_t next = size_t(std::upper_bound(times_.begin(), times_.end(), time) - times_.begin());
    return between(next - 1, (time - times_[next - 1]) / (times_[next] - times_[next - 1]));
}

void Channel::apply(double time, Placement &placement) const {
    const Imath::V4d value = at(time);
    const Imath::V3d vector(value.x, value.y, value.z);
    switch (path_) {
    case Path::Translation:
        placement.translation = vector;
        break;
    case Path::Rotation:
        placement.rotation = rotation(value);
        break;
    case Path::Scale:
        placement.scale = vector;
        break;
    }
}

std::vector<Channel> read_channels(const tinygltf::Model &model, const Notes &notes) {
    std::vector<Channel> channels;
    for (size_t a = 0; a < model.animations.size(); ++a) {
        const tinygltf::Animation &animation = model.animations[a];
        for (size_t c = 0; c < animation.channels.size(); ++c) {
            const tinygltf::AnimationChannel &channel = animation.channels[c];
            const std::string where = "animation " + std::to_string(a) + ", channel " + std::to_string(c);
            if (channel.target_node < 0) continue; /* to be ignored, by the specification */
            if (size_t(channel.target_node) >= model.nodes.size())
                throw std::runtime_error(where + " moves node " + std::to_string(channel.target_node) +
                                         ", which is not there");
            if (channel.sampler < 0 || size_t(channel.sampler) >= animation.samplers.size())
                throw std::runtime_error(where + " uses sampler " + std::to_string(channel.sampler) +
                                         ", which is not there");
            const auto add = [&](Channel::Path path) {
                channels.emplace_back(model, animation.samplers[size_t(channel.sampler)], size_t(channel.target_node),
                                      path, where);
            };
            if (!model.nodes[size_t(channel.target_node)].matrix.empty())
                notes(where + ": its node has a matrix, which can't be animated; left out");
            else if (channel.target_path == "translation")
                add(Channel::Path::Translation);
            else if (channel.target_path == "rotation")
                add(Channel::Path::Rotation);
            else if (channel.target_path == "scale")
                add(Channel::Path::Scale);
            else
                notes(where + ": animates '" + channel.target_path + "', which is not played");
        }
    }
    return channels;
}

} // namespace demo
