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
#include <stdexcept>

namespace {

template <typename T> T *allocate(size_t count) {
    return static_cast<T *>(bench_allocate(count, sizeof(T)));
}

/* Its float copies are what both sides and the exact answers know. */
bench_mesh *copy_mesh(const std::vector<double> &vertices, const std::vector<uint32_t> &corners) {
    for (uint32_t corner : corners)
        if (corner >= vertices.size() / 3) throw std::runtime_error("has an index without a vertex");
    bench_mesh *mesh = allocate<bench_mesh>(1);
    mesh->vertex_count = static_cast<uint32_t>(vertices.size() / 3);
    mesh->triangle_count = static_cast<uint32_t>(corners.size() / 3);
    mesh->vertices = allocate<float>(vertices.size() + 1);
    mesh->corners = allocate<uint32_t>(corners.size());
    std::transform(vertices.begin(), vertices.end(), mesh->vertices, [](double x) { return static_cast<float>(x); });
    std::copy(corners.begin(), corners.end(), mesh->corners);
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

/* The cube around a box. */
struct Fit {
    explicit Fit(const Imath::Box3d &box)
        : side(std::max({box.size().x, box.size().y, box.size().z})), lo(box.center() - Imath::V3d(side / 2)) {}
    double side;
    Imath::V3d lo;
};

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
        const demo::Surface &surface = model.surfaces()[part.surface];
        shape.mesh = copy_mesh(surface.vertices, surface.corners);
        shape.reach = reach(shape.mesh, transforms[part.node]);
        scene->shape_of[i] = static_cast<uint8_t>(i);
        for (uint32_t v = 0; v < shape.mesh->vertex_count; ++v) {
            box.extendBy(vertex(shape.mesh, v) * transforms[part.node]);
        }
    }
    const Fit fit(box);
    for (uint32_t i = 0; i < count; ++i) place(scene, i, transforms[model.parts()[i].node], fit.lo, 1 / fit.side);
    bench_settle(scene);
    return scene;
}

/* The vertices as the file has them: those of a seam are there twice. */
bench_mesh *join(const demo::Model &model) {
    const std::vector<Imath::M44d> transforms = model.transforms(0);
    std::vector<Imath::V3d> points;
    std::vector<uint32_t> corners;
    Imath::Box3d box;
    for (const demo::Model::Part &part : model.parts()) {
        const demo::Surface &surface = model.surfaces()[part.surface];
        const uint32_t first = static_cast<uint32_t>(points.size());
        for (uint32_t corner : surface.corners) corners.push_back(first + corner);
        for (size_t v = 0; v + 2 < surface.vertices.size(); v += 3) {
            const double *p = &surface.vertices[v];
            points.push_back(Imath::V3d(p[0], p[1], p[2]) * transforms[part.node]);
            box.extendBy(points.back());
        }
    }
    const Fit fit(box);
    std::vector<double> vertices;
    for (const Imath::V3d &point : points)
        for (int k = 0; k < 3; ++k) vertices.push_back((point[k] - fit.lo[k]) / fit.side);
    return copy_mesh(vertices, corners);
}

template <typename F> bench_scene *read(const char *path, F make) {
    try {
        return make(demo::Model(path, [](const std::string &) {}));
    } catch (const std::exception &error) {
        std::fprintf(stderr, "%s: %s\n", path, error.what());
        return nullptr;
    }
}

} // namespace

const char *bench_gltf_usual(void) {
    static const demo::Options options;
    return options.gltf.c_str();
}

bench_scene *bench_gltf_scene(const char *path) {
    return read(path, convert);
}

bench_scene *bench_gltf_mesh(const char *path, const char *name) {
    return read(path, [=](const demo::Model &model) {
        bench_mesh *mesh = join(model);
        return bench_scene_of_mesh(name, mesh->triangle_count, mesh);
    });
}
