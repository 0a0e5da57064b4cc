/* SPDX-License-Identifier: MIT */
#include "gltf_model.h"

#include "gltf_file.h"

#include <algorithm>
#include <cmath>

namespace demo {

namespace {

std::string named(const char *kind, size_t index, const std::string &name) {
    return std::string(kind) + " " + std::to_string(index) + (name.empty() ? "" : " '" + name + "'");
}

Imath::V3d vector(const std::vector<double> &numbers, const Imath::V3d &otherwise) {
    return numbers.size() == 3 ? Imath::V3d(numbers[0], numbers[1], numbers[2]) : otherwise;
}

/* Scale first, then turn, then shift: the order of the specification, left to right for row vectors. */
Imath::M44d matrix(const Placement &placement) {
    Imath::M44d scale, shift;
    scale.setScale(placement.scale);
    shift.setTranslation(placement.translation);
    return scale * placement.rotation.toMatrix44() * shift;
}

/* Columns of a matrix for column vectors, as glTF stores it, are the rows of the same for row vectors. */
Imath::M44d matrix(const std::vector<double> &m) {
    return Imath::M44d(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8], m[9], m[10], m[11], m[12], m[13], m[14],
                       m[15]);
}

} // namespace

Model::Model(const std::string &path, const Notes &notes) {
    const tinygltf::Model model = load_gltf(path, notes);
    read_nodes(model);
    read_tree(model);
    read_parts(model, notes);
    channels_ = read_channels(model, notes);
    for (const Channel &channel : channels_) duration_ = std::max(duration_, channel.end());
}

void Model::read_nodes(const tinygltf::Model &model) {
    for (size_t i = 0; i < model.nodes.size(); ++i) {
        const tinygltf::Node &from = model.nodes[i];
        Node node;
        node.has_matrix = !from.matrix.empty();
        if (node.has_matrix) node.matrix = matrix(from.matrix);
        if (node.has_matrix &&
            (node.matrix[0][3] != 0 || node.matrix[1][3] != 0 || node.matrix[2][3] != 0 || node.matrix[3][3] != 1))
            throw std::runtime_error(named("node", i, from.name) + " has a matrix that is not affine");
        node.placement.translation = vector(from.translation, Imath::V3d(0));
        node.placement.scale = vector(from.scale, Imath::V3d(1));
        if (from.rotation.size() == 4)
            node.placement.rotation =
                rotation(Imath::V4d(from.rotation[0], from.rotation[1], from.rotation[2], from.rotation[3]));
        nodes_.push_back(node);
    }
}

/* Walks down from one root without recursion, so that a long chain of nodes can't exhaust the stack. */
void Model::visit(const tinygltf::Model &model, int root, std::vector<bool> &seen) {
    struct Step {
        int node;
        size_t parent;
    };
    for (std::vector<Step> open = {{root, size_t(-1)}}; !open.empty();) {
        const Step step = open.back();
        open.pop_back();
        if (step.node < 0 || size_t(step.node) >= nodes_.size())
            throw std::runtime_error("node " + std::to_string(step.node) + " is used but not there");
        const size_t index = size_t(step.node);
        if (seen[index])
            throw std::runtime_error(named("node", index, model.nodes[index].name) +
                                     " is reached twice: nodes must form trees, without loops");
        seen[index] = true;
        nodes_[index].parent = step.parent;
        order_.push_back(index);
        for (const int child : model.nodes[index].children) open.push_back({child, index});
    }
}

/* The scene that the file names, or its first; without any scene, all nodes that are nobody's child. */
void Model::read_tree(const tinygltf::Model &model) {
    std::vector<int> roots;
    const int scene = model.defaultScene >= 0 ? model.defaultScene : 0;
    if (size_t(scene) < model.scenes.size()) {
        roots = model.scenes[size_t(scene)].nodes;
    } else if (model.defaultScene >= 0) {
        throw std::runtime_error("scene " + std::to_string(scene) + " is to be shown but not there");
    } else {
        std::vector<bool> child(nodes_.size(), false);
        for (const tinygltf::Node &node : model.nodes)
            for (const int c : node.children)
                if (c >= 0 && size_t(c) < nodes_.size()) child[size_t(c)] = true;
        for (size_t i = 0; i < nodes_.size(); ++i)
            if (!child[i]) roots.push_back(int(i));
        if (roots.empty() && !nodes_.empty())
            throw std::runtime_error("every node is a child: nodes must form trees, without loops");
    }
    std::vector<bool> seen(nodes_.size(), false);
    for (const int root : roots) visit(model, root, seen);
}

void Model::read_parts(const tinygltf::Model &model, const Notes &notes) {
    std::vector<std::vector<size_t>> surfaces_of(model.meshes.size());
    for (size_t m = 0; m < model.meshes.size(); ++m) {
        const tinygltf::Mesh &mesh = model.meshes[m];
        for (size_t p = 0; p < mesh.primitives.size(); ++p) {
            const std::string where = named("mesh", m, mesh.name) + ", primitive " + std::to_string(p);
            Surface surface = read_primitive(model, mesh.primitives[p], where, notes);
            if (surface.corners.empty()) continue;
            surfaces_of[m].push_back(surfaces_.size());
            surfaces_.push_back(std::move(surface));
        }
    }
    for (const size_t index : order_) {
        const tinygltf::Node &node = model.nodes[index];
        if (node.mesh < 0) continue;
        if (size_t(node.mesh) >= model.meshes.size())
            throw std::runtime_error(named("node", index, node.name) + " uses mesh " + std::to_string(node.mesh) +
                                     ", which is not there");
        if (node.skin >= 0) notes(named("node", index, node.name) + ": its skin is left out");
        for (const size_t surface : surfaces_of[size_t(node.mesh)])
            parts_.push_back(
                {index, surface, named("node", index, node.name) + ", mesh " + std::to_string(node.mesh)});
    }
    if (parts_.empty()) throw std::runtime_error("has no triangles in its scene");
}

std::vector<Imath::M44d> Model::transforms(double time) const {
    std::vector<Placement> placements;
    for (const Node &node : nodes_) placements.push_back(node.placement);
    for (const Channel &channel : channels_) channel.apply(time, placements[channel.node()]);
    std::vector<Imath::M44d> worlds(nodes_.size());
    for (const size_t index : order_) {
        const Node &node = nodes_[index];
        const Imath::M44d own = node.has_matrix ? node.matrix : matrix(placements[index]);
        worlds[index] = node.parent == size_t(-1) ? own : own * worlds[node.parent];
    }
    return worlds;
}

} // namespace demo
