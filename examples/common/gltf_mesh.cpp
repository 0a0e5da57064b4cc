/* SPDX-License-Identifier: MIT */
#include "gltf_mesh.h"

#include "gltf_accessor.h"

#include <cmath>
#include <numeric>

namespace demo {

namespace {

/* Strips change their winding with each triangle; fans share their first corner. */
std::vector<uint32_t> triangles(const std::vector<uint32_t> &run, int mode) {
    if (mode == TINYGLTF_MODE_TRIANGLES)
        return std::vector<uint32_t>(run.begin(), run.end() - std::ptrdiff_t(run.size() % 3));
    std::vector<uint32_t> corners;
    for (size_t i = 2; i < run.size(); ++i) {
        const bool odd = i % 2 == 1;
        const uint32_t first = mode == TINYGLTF_MODE_TRIANGLE_FAN ? run[0] : run[odd ? i - 1 : i - 2];
        const uint32_t second = mode == TINYGLTF_MODE_TRIANGLE_FAN || !odd ? run[i - 1] : run[i - 2];
        corners.insert(corners.end(), {first, second, run[i]});
    }
    return corners;
}

/* Shading falls back on the geometric normals if any of the file's is no direction. */
std::vector<Imath::V3f> read_normals(const tinygltf::Model &model, const tinygltf::Primitive &primitive,
                                     size_t vertices, const std::string &where, const Notes &notes) {
    const auto found = primitive.attributes.find("NORMAL");
    if (found == primitive.attributes.end()) return {};
    const std::vector<double> numbers = read_accessor(model, found->second, 3);
    std::vector<Imath::V3f> normals;
    for (size_t i = 0; i + 2 < numbers.size(); i += 3) {
        const Imath::V3d normal(numbers[i], numbers[i + 1], numbers[i + 2]);
        if (!(normal.length() > 1e-6 && std::isfinite(normal.length()))) break;
        normals.emplace_back(normal.normalized());
    }
    if (normals.size() == vertices) return normals;
    notes(where + ": bad normals, so it is shaded flat");
    return {};
}

void read_material(const tinygltf::Model &model, const tinygltf::Primitive &primitive, const std::string &where,
                   Surface &surface) {
    if (primitive.material < 0) return;
    if (size_t(primitive.material) >= model.materials.size())
        throw std::runtime_error(where + " uses material " + std::to_string(primitive.material) +
                                 ", which is not there");
    const auto &material = model.materials[size_t(primitive.material)].pbrMetallicRoughness;
    const auto clamp = [](double value) { return std::fmin(std::fmax(value, 0.0), 1.0); };
    if (material.baseColorFactor.size() == 4)
        for (int c = 0; c < 3; ++c) surface.colour[c] = float(clamp(material.baseColorFactor[size_t(c)]));
    surface.gloss = float(1 - clamp(material.roughnessFactor));
}

} // namespace

Surface read_primitive(const tinygltf::Model &model, const tinygltf::Primitive &primitive, const std::string &where,
                       const Notes &notes) {
    Surface surface;
    surface.name = where;
    const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
    if (mode > TINYGLTF_MODE_TRIANGLE_FAN)
        throw std::runtime_error(where + " has mode " + std::to_string(mode) + ", which glTF 2 has not");
    const auto positions = primitive.attributes.find("POSITION");
    if (mode < TINYGLTF_MODE_TRIANGLES || positions == primitive.attributes.end()) {
        notes(where + (mode < TINYGLTF_MODE_TRIANGLES ? ": points or lines, left out" : ": no positions, left out"));
        return surface;
    }
    read_material(model, primitive, where, surface);
    surface.vertices = read_accessor(model, positions->second, 3);
    const size_t count = surface.vertices.size() / 3;

    std::vector<uint32_t> run(count);
    std::iota(run.begin(), run.end(), 0u);
    if (primitive.indices >= 0) run = read_indices(model, primitive.indices);
    surface.corners = triangles(run, mode);
    if (surface.corners.empty()) notes(where + ": not one whole triangle, left out");
    if (mode == TINYGLTF_MODE_TRIANGLES && run.size() % 3 != 0)
        notes(where + ": " + std::to_string(run.size()) + " corners are no whole number of triangles");
    surface.normals = read_normals(model, primitive, count, where, notes);
    return surface;
}

} // namespace demo
