/* SPDX-License-Identifier: MIT */
#include "gltf_check.h"

#include <climits>
#include <cstring>
#include <jansson.h>
#include <memory>
#include <stdexcept>

namespace demo {

namespace {

enum class Kind { Object, Objects, String, Strings, Boolean, Number, Numbers, Index, Indices, IndexMap, Size };

struct Rule {
    const char *path; /* names from the root, arrays passed over */
    Kind kind;
    size_t count; /* Numbers: how many; 0: any */
};

const Rule rules[] = {
    {"asset", Kind::Object, 0},
    {"asset.version", Kind::String, 0},
    {"asset.minVersion", Kind::String, 0},
    {"extensionsUsed", Kind::Strings, 0},
    {"extensionsRequired", Kind::Strings, 0},
    {"scene", Kind::Index, 0},
    {"scenes", Kind::Objects, 0},
    {"scenes.nodes", Kind::Indices, 0},
    {"nodes", Kind::Objects, 0},
    {"nodes.children", Kind::Indices, 0},
    {"nodes.mesh", Kind::Index, 0},
    {"nodes.skin", Kind::Index, 0},
    {"nodes.camera", Kind::Index, 0},
    {"nodes.matrix", Kind::Numbers, 16},
    {"nodes.translation", Kind::Numbers, 3},
    {"nodes.rotation", Kind::Numbers, 4},
    {"nodes.scale", Kind::Numbers, 3},
    {"nodes.weights", Kind::Numbers, 0},
    {"meshes", Kind::Objects, 0},
    {"meshes.weights", Kind::Numbers, 0},
    {"meshes.primitives", Kind::Objects, 0},
    {"meshes.primitives.attributes", Kind::IndexMap, 0},
    {"meshes.primitives.indices", Kind::Index, 0},
    {"meshes.primitives.material", Kind::Index, 0},
    {"meshes.primitives.mode", Kind::Index, 0},
    {"meshes.primitives.targets", Kind::Objects, 0},
    {"accessors", Kind::Objects, 0},
    {"accessors.bufferView", Kind::Index, 0},
    {"accessors.byteOffset", Kind::Size, 0},
    {"accessors.componentType", Kind::Index, 0},
    {"accessors.normalized", Kind::Boolean, 0},
    {"accessors.count", Kind::Size, 0},
    {"accessors.type", Kind::String, 0},
    {"accessors.min", Kind::Numbers, 0},
    {"accessors.max", Kind::Numbers, 0},
    {"accessors.sparse", Kind::Object, 0},
    {"accessors.sparse.count", Kind::Index, 0},
    {"accessors.sparse.indices", Kind::Object, 0},
    {"accessors.sparse.indices.bufferView", Kind::Index, 0},
    {"accessors.sparse.indices.byteOffset", Kind::Index, 0},
    {"accessors.sparse.indices.componentType", Kind::Index, 0},
    {"accessors.sparse.values", Kind::Object, 0},
    {"accessors.sparse.values.bufferView", Kind::Index, 0},
    {"accessors.sparse.values.byteOffset", Kind::Index, 0},
    {"bufferViews", Kind::Objects, 0},
    {"bufferViews.buffer", Kind::Index, 0},
    {"bufferViews.byteOffset", Kind::Size, 0},
    {"bufferViews.byteLength", Kind::Size, 0},
    {"bufferViews.byteStride", Kind::Size, 0},
    {"bufferViews.target", Kind::Index, 0},
    {"buffers", Kind::Objects, 0},
    {"buffers.byteLength", Kind::Size, 0},
    {"buffers.uri", Kind::String, 0},
    {"materials", Kind::Objects, 0},
    {"materials.doubleSided", Kind::Boolean, 0},
    {"materials.alphaMode", Kind::String, 0},
    {"materials.alphaCutoff", Kind::Number, 0},
    {"materials.emissiveFactor", Kind::Numbers, 3},
    {"materials.emissiveTexture", Kind::Object, 0},
    {"materials.emissiveTexture.index", Kind::Index, 0},
    {"materials.normalTexture", Kind::Object, 0},
    {"materials.normalTexture.index", Kind::Index, 0},
    {"materials.normalTexture.scale", Kind::Number, 0},
    {"materials.occlusionTexture", Kind::Object, 0},
    {"materials.occlusionTexture.index", Kind::Index, 0},
    {"materials.occlusionTexture.strength", Kind::Number, 0},
    {"materials.pbrMetallicRoughness", Kind::Object, 0},
    {"materials.pbrMetallicRoughness.baseColorFactor", Kind::Numbers, 4},
    {"materials.pbrMetallicRoughness.metallicFactor", Kind::Number, 0},
    {"materials.pbrMetallicRoughness.roughnessFactor", Kind::Number, 0},
    {"materials.pbrMetallicRoughness.baseColorTexture", Kind::Object, 0},
    {"materials.pbrMetallicRoughness.baseColorTexture.index", Kind::Index, 0},
    {"materials.pbrMetallicRoughness.metallicRoughnessTexture", Kind::Object, 0},
    {"materials.pbrMetallicRoughness.metallicRoughnessTexture.index", Kind::Index, 0},
    {"textures", Kind::Objects, 0},
    {"textures.sampler", Kind::Index, 0},
    {"textures.source", Kind::Index, 0},
    {"samplers", Kind::Objects, 0},
    {"images", Kind::Objects, 0},
    {"images.uri", Kind::String, 0},
    {"images.mimeType", Kind::String, 0},
    {"images.bufferView", Kind::Index, 0},
    {"animations", Kind::Objects, 0},
    {"animations.channels", Kind::Objects, 0},
    {"animations.channels.sampler", Kind::Index, 0},
    {"animations.channels.target", Kind::Object, 0},
    {"animations.channels.target.node", Kind::Index, 0},
    {"animations.channels.target.path", Kind::String, 0},
    {"animations.samplers", Kind::Objects, 0},
    {"animations.samplers.input", Kind::Index, 0},
    {"animations.samplers.output", Kind::Index, 0},
    {"animations.samplers.interpolation", Kind::String, 0},
    {"skins", Kind::Objects, 0},
    {"skins.joints", Kind::Indices, 0},
    {"skins.skeleton", Kind::Index, 0},
    {"skins.inverseBindMatrices", Kind::Index, 0},
    {"cameras", Kind::Objects, 0},
};

bool is_index(const json_t *value) {
    return json_is_integer(value) && json_integer_value(value) >= 0 && json_integer_value(value) <= INT_MAX;
}

/* What no address space holds is refused here, so that sums of two such numbers can't overflow. */
bool is_size(const json_t *value) {
    return json_is_integer(value) && json_integer_value(value) >= 0 && json_integer_value(value) < (1LL << 48);
}

bool is_object(const json_t *value) {
    return json_is_object(value);
}
bool is_string(const json_t *value) {
    return json_is_string(value);
}
bool is_number(const json_t *value) {
    return json_is_number(value);
}

bool all(const json_t *array, bool (*test)(const json_t *)) {
    if (!json_is_array(array)) return false;
    for (size_t i = 0; i < json_array_size(array); ++i)
        if (!test(json_array_get(array, i))) return false;
    return true;
}

bool all_members(json_t *object, bool (*test)(const json_t *)) {
    if (!json_is_object(object)) return false;
    for (void *i = json_object_iter(object); i; i = json_object_iter_next(object, i))
        if (!test(json_object_iter_value(i))) return false;
    return true;
}

/* Returns what the value should be, or "" if it is. */
std::string mismatch(const Rule &rule, json_t *value) {
    switch (rule.kind) {
    case Kind::Object:
        return json_is_object(value) ? "" : "an object";
    case Kind::Objects:
        return all(value, is_object) ? "" : "an array of objects";
    case Kind::String:
        return json_is_string(value) ? "" : "a string";
    case Kind::Strings:
        return all(value, is_string) ? "" : "an array of strings";
    case Kind::Boolean:
        return json_is_boolean(value) ? "" : "true or false";
    case Kind::Number:
        return json_is_number(value) ? "" : "a number";
    case Kind::Index:
        return is_index(value) ? "" : "an integer from 0 to 2147483647";
    case Kind::Indices:
        return all(value, is_index) ? "" : "an array of indices";
    case Kind::IndexMap:
        return all_members(value, is_index) ? "" : "an object of indices";
    case Kind::Size:
        return is_size(value) ? "" : "a size or count";
    case Kind::Numbers:
        break;
    }
    if (all(value, is_number) && (rule.count == 0 || rule.count == json_array_size(value))) return "";
    return rule.count == 0 ? "an array of numbers" : "an array of " + std::to_string(rule.count) + " numbers";
}

[[noreturn]] void fail(const std::string &where, const std::string &wanted) {
    throw std::runtime_error(where + " is not " + wanted);
}

void check_object(json_t *object, const std::string &path, const std::string &where);

void check_member(const char *key, json_t *value, const std::string &parent_path, const std::string &parent) {
    const std::string path = parent_path.empty() ? key : parent_path + "." + key;
    const std::string where = parent.empty() ? key : parent + "." + key;
    if (std::strcmp(key, "extras") == 0) return;
    if (std::strcmp(key, "extensions") == 0 && !all_members(value, is_object)) fail(where, "an object of objects");
    if (std::strcmp(key, "name") == 0 && !json_is_string(value)) fail(where, "a string");
    for (const Rule &rule : rules) {
        if (path != rule.path) continue;
        const std::string wanted = mismatch(rule, value);
        if (!wanted.empty()) fail(where, wanted);
        if (rule.kind == Kind::Object) check_object(value, path, where);
        if (rule.kind != Kind::Objects) return;
        for (size_t i = 0; i < json_array_size(value); ++i)
            check_object(json_array_get(value, i), path, where + "[" + std::to_string(i) + "]");
        return;
    }
}

void check_object(json_t *object, const std::string &path, const std::string &where) {
    for (void *i = json_object_iter(object); i; i = json_object_iter_next(object, i))
        check_member(json_object_iter_key(i), json_object_iter_value(i), path, where);
}

/* What an extension of these families says is about looks alone, or is read anyway (quantization). */
bool is_harmless(const std::string &extension) {
    for (const char *family : {"KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_", "KHR_technique",
                               "KHR_mesh_quantization", "MSFT_texture_"})
        if (extension.compare(0, std::strlen(family), family) == 0) return true;
    return false;
}

void check_kind_of_file(json_t *root) {
    const char *version = json_string_value(json_object_get(json_object_get(root, "asset"), "version"));
    if (!version) throw std::runtime_error("has no asset.version, so it is not glTF");
    if (std::strncmp(version, "2.", 2) != 0)
        throw std::runtime_error("is glTF of version '" + std::string(version) + "', not 2");
    const json_t *required = json_object_get(root, "extensionsRequired");
    for (size_t i = 0; i < json_array_size(required); ++i) {
        const std::string extension = json_string_value(json_array_get(required, i));
        if (!is_harmless(extension))
            throw std::runtime_error("needs the extension '" + extension + "', which this program can't read");
    }
}

} // namespace

void check_gltf_json(const char *text, size_t size) {
    json_error_t error;
    const std::unique_ptr<json_t, void (*)(json_t *)> root(json_loadb(text, size, JSON_REJECT_DUPLICATES, &error),
                                                           [](json_t *value) { json_decref(value); });
    if (!root)
        throw std::runtime_error("is not JSON: line " + std::to_string(error.line) + ", column " +
                                 std::to_string(error.column) + ": " + error.text);
    if (!json_is_object(root.get())) throw std::runtime_error("is not a JSON object");
    check_object(root.get(), "", "");
    check_kind_of_file(root.get());
}

} // namespace demo
