/* SPDX-License-Identifier: MIT */
/* gltf_model.h: a glTF file as it is shown: a tree of nodes that may move, and the surfaces on them. */
#ifndef DEMO_GLTF_MODEL_H
#define DEMO_GLTF_MODEL_H

#include "gltf_animation.h"

#include <Imath/ImathMatrix.h>

namespace demo {

class Model {
  public:
    /** One surface on one node. */
    struct Part {
        size_t node;
        size_t surface;
        std::string name; /* for messages */
    };

    /**
     * Reads a .gltf or .glb file. Throws std::runtime_error that says what is wrong with it; what is merely not
     * supported goes to `notes`. There is at least one part in the end.
     */
    Model(const std::string &path, const Notes &notes);

    const std::vector<Surface> &surfaces() const { return surfaces_; }
    const std::vector<Part> &parts() const { return parts_; }

    /** Seconds until the last of its animations ends; 0 if none moves a node. */
    double duration() const { return duration_; }

    /** The transform of each node to the world at `time` seconds, for row vectors as Imath has them. */
    std::vector<Imath::M44d> transforms(double time) const;

  private:
    struct Node {
        Placement placement;
        Imath::M44d matrix; /* used in place of the placement if has_matrix */
        bool has_matrix = false;
        size_t parent = size_t(-1);
    };

    void read_nodes(const tinygltf::Model &model);
    void read_tree(const tinygltf::Model &model);
    void visit(const tinygltf::Model &model, int root, std::vector<bool> &seen);
    void read_parts(const tinygltf::Model &model, const Notes &notes);

    std::vector<Node> nodes_;
    std::vector<size_t> order_; /* the nodes of the scene, parents first */
    std::vector<Surface> surfaces_;
    std::vector<Part> parts_;
    std::vector<Channel> channels_;
    double duration_ = 0;
};

} // namespace demo

#endif
