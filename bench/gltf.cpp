/* SPDX-License-Identifier: MIT */
extern "C" {
#include "gltf.h"
#include "measure.h"
}

#include <Imath/ImathBox.h>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <gltf_model.h>
#include <options.h>

namespace {

template <typename T> T *allocate(size_t count) {
    return static_cast<T *>(bench_allocate(count, sizeof(T)));
}

/* Its float copies are what both sides and the exact answers know. */
bench_mesh *copy_mesh(const demo::Surface &surface) {
    bench_mesh *mesh = allocate<bench_mesh>(1);
    mesh->vertex_count = static_cast<uint32_t>(surface.vertices.size() / 3);
    mesh->triangle_count = static_cast<uint32_t>(surface.corners.size() / 3);
    mesh->vertices = allocate<float>(surface.vertices.size() + 1);
    mesh->corners = allocate<uint32_t>(surface.corners.size());
    std::transform(surface.vertices.begin(), surface.vertices.end(), mesh->vertices,
                   [](double x) { return static_cast<float>(x); });
    std::copy(surface.corners.begin(), surface.corners.end(), mesh->corners);
    return mesh;
}

Imath::V3d vertex(const bench_mesh *mesh, uint32_t which) {
    const float *v = mesh->vertices + 3 * size_t(which);
    return Imath::V3d(v[0], v[1], v[2]);
}

/* How far the part reaches from its position, without the scale that all have. */
double reach(const bench_mesh *mesh, const Imath::M44d &transform) {
    double longest = 0;
    for (uint32_t i = 0; i < mesh->vertex_count; ++i) {
        Imath::V3d turned;
        transform.multDirMatrix(vertex(mesh, i), turned);
        longest = std::max(longest, turned.length());
    }
    return longest;
}

/* Imath has row vectors, so its rows are the columns of a pose. */
void place(bench_scene *scene, uint32_t which, const Imath::M44d &transform, const Imath::V3d &lo, double scale) {
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) scene->linears[which][3 * r + c] = static_cast<float>(transform[c][r]);
        scene->positions[which][r] = static_cast<float>((transform[3][r] - lo[r]) * scale);
    }
    scene->scales[which] = static_cast<float>(scale);
}

bench_scene *convert(const demo::Model &model) {
    const std::vector<Imath::M44d> transforms = model.transforms(0);
    const uint32_t count = static_cast<uint32_t>(std::min<size_t>(model.parts().size(), BENCH_SHAPES));
    bench_scene *scene = allocate<bench_scene>(1);
    scene->name = "gltf";
    scene->count = scene->size = count;
    scene->random = count;
    scene->shape_count = static_cast<int>(count);
    scene->shapes = allocate<bench_shape>(count);
    scene->shape_of = allocate<uint8_t>(count);
    scene->positions = static_cast<double(*)[3]>(bench_allocate(count, sizeof *scene->positions));
    scene->scales = allocate<double>(count);
    scene->linears = static_cast<float(*)[9]>(bench_allocate(count, sizeof *scene->linears));
    Imath::Box3d box;
    for (uint32_t i = 0; i < count; ++i) {
        const demo::Model::Part &part = model.parts()[i];
        bench_shape &shape = scene->shapes[i];
        shape.kind = RG_SHAPE_MESH;
        shape.mesh = copy_mesh(model.surfaces()[part.surface]);
        shape.reach = reach(shape.mesh, transforms[part.node]);
        scene->shape_of[i] = static_cast<uint8_t>(i);
        for (uint32_t v = 0; v < shape.mesh->vertex_count; ++v) {
            box.extendBy(vertex(shape.mesh, v) * transforms[part.node]);
        }
    }
    const Imath::V3d size = box.size();
    const double side = std::max({size.x, size.y, size.z});
    const Imath::V3d lo = box.center() - Imath::V3d(side / 2);
    for (uint32_t i = 0; i < count; ++i) place(scene, i, transforms[model.parts()[i].node], lo, 1 / side);
    bench_settle(scene);
    return scene;
}

} // namespace

const char *bench_gltf_usual(void) {
    static const demo::Options options;
    return options.gltf.c_str();
}

bench_scene *bench_gltf_scene(const char *path) {
    try {
        return convert(demo::Model(path, [](const std::string &) {}));
    } catch (const std::exception &error) {
        std::fprintf(stderr, "%s\n", error.what());
        return nullptr;
    }
}
