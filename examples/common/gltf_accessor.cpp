/* SPDX-License-Identifier: MIT */
#include "gltf_accessor.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <string>

namespace demo {

namespace {

/* An accessor without a buffer view takes no bytes of the file, so its count bounds nothing: this does. */
constexpr size_t most_elements = size_t(1) << 25;

[[noreturn]] void fail(int accessor, const std::string &what) {
    throw std::runtime_error("accessor " + std::to_string(accessor) + " " + what);
}

/* Elements of one type, `stride` bytes apart, in a buffer. */
struct Elements {
    const unsigned char *data;
    size_t stride;
    int type;
    int components;
    bool normalized;
};

size_t component_size(int accessor, int type) {
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return 4;
    default:
        fail(accessor, "has the component type " + std::to_string(type) + ", which glTF 2 has not");
    }
}

template <typename T> double load(const unsigned char *from) {
    T value;
    std::memcpy(&value, from, sizeof value);
    return static_cast<double>(value);
}

double component(const Elements &elements, const unsigned char *from) {
    double value = 0, largest = 1;
    switch (elements.type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        value = load<int8_t>(from), largest = INT8_MAX;
        break;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        value = load<uint8_t>(from), largest = UINT8_MAX;
        break;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        value = load<int16_t>(from), largest = INT16_MAX;
        break;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        value = load<uint16_t>(from), largest = UINT16_MAX;
        break;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return load<uint32_t>(from);
    default:
        return load<float>(from);
    }
    return elements.normalized ? std::max(value / largest, -1.0) : value;
}

/* `offset` and all sizes are below 2^48 (gltf_check), so that their sums can't wrap. */
Elements locate(const tinygltf::Model &model, int accessor, int view_index, size_t offset, size_t count,
                Elements elements) {
    if (view_index < 0 || size_t(view_index) >= model.bufferViews.size())
        fail(accessor, "uses buffer view " + std::to_string(view_index) + ", which is not there");
    const tinygltf::BufferView &view = model.bufferViews[size_t(view_index)];
    if (view.buffer < 0 || size_t(view.buffer) >= model.buffers.size())
        fail(accessor, "uses buffer " + std::to_string(view.buffer) + ", which is not there");
    const std::vector<unsigned char> &bytes = model.buffers[size_t(view.buffer)].data;
    if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset)
        fail(accessor, "uses buffer view " + std::to_string(view_index) + ", which runs beyond its buffer");

    const size_t element = component_size(accessor, elements.type) * size_t(elements.components);
    elements.stride = view.byteStride == 0 ? element : view.byteStride;
    if (elements.stride < element)
        fail(accessor, "has elements that overlap: the stride of its buffer view is too small");
    const bool fits = offset <= view.byteLength && element <= view.byteLength - offset &&
                      (count - 1) <= (view.byteLength - offset - element) / elements.stride;
    if (!fits)
        fail(accessor, "has " + std::to_string(count) + " elements, more than buffer view " +
                           std::to_string(view_index) + " holds");
    elements.data = bytes.data() + view.byteOffset + offset;
    return elements;
}

void read_one(const Elements &elements, size_t index, double *to) {
    const unsigned char *from = elements.data + index * elements.stride;
    const size_t size = component_size(-1, elements.type);
    for (int c = 0; c < elements.components; ++c) to[c] = component(elements, from + size_t(c) * size);
}

void apply_sparse(const tinygltf::Model &model, int index, const tinygltf::Accessor &accessor, Elements type,
                  std::vector<double> &numbers) {
    const auto &sparse = accessor.sparse;
    const size_t count = size_t(sparse.count);
    if (count == 0 || count > accessor.count) fail(index, "has a sparse count that is 0 or beyond its own count");
    Elements places = {nullptr, 0, sparse.indices.componentType, 1, false};
    places = locate(model, index, sparse.indices.bufferView, size_t(sparse.indices.byteOffset), count, places);
    type = locate(model, index, sparse.values.bufferView, size_t(sparse.values.byteOffset), count, type);
    for (size_t i = 0; i < count; ++i) {
        double place = 0;
        read_one(places, i, &place);
        if (!(place >= 0 && place < double(accessor.count)))
            fail(index, "has a sparse index that is no element of it");
        read_one(type, i, &numbers[size_t(place) * size_t(type.components)]);
    }
}

const tinygltf::Accessor &find(const tinygltf::Model &model, int index, int components) {
    if (index < 0 || size_t(index) >= model.accessors.size()) fail(index, "is used but not there");
    const tinygltf::Accessor &accessor = model.accessors[size_t(index)];
    if (tinygltf::GetNumComponentsInType(uint32_t(accessor.type)) != components)
        fail(index, "has not " + std::to_string(components) + " component(s) an element, as it must have here");
    if (accessor.count == 0) fail(index, "has no elements");
    if (accessor.count > most_elements) fail(index, "has more elements than this program reads");
    return accessor;
}

} // namespace

std::vector<double> read_accessor(const tinygltf::Model &model, int index, int components) {
    const tinygltf::Accessor &accessor = find(model, index, components);
    const Elements type = {nullptr, 0, accessor.componentType, components, accessor.normalized};
    component_size(index, type.type);
    std::vector<double> numbers;
    if (accessor.bufferView >= 0) {
        const Elements elements =
            locate(model, index, accessor.bufferView, accessor.byteOffset, accessor.count, type);
        numbers.resize(accessor.count * size_t(components));
        for (size_t i = 0; i < accessor.count; ++i) read_one(elements, i, &numbers[i * size_t(components)]);
    } else {
        numbers.resize(accessor.count * size_t(components)); /* zeros, by the specification */
    }
    if (accessor.sparse.isSparse) apply_sparse(model, index, accessor, type, numbers);
    return numbers;
}

std::vector<uint32_t> read_indices(const tinygltf::Model &model, int index) {
    const int type = find(model, index, 1).componentType;
    const bool is_unsigned = type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                             type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                             type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    if (!is_unsigned || model.accessors[size_t(index)].normalized)
        fail(index, "holds no unsigned integers, as indices must");
    const std::vector<double> numbers = read_accessor(model, index, 1);
    return std::vector<uint32_t>(numbers.begin(), numbers.end());
}

} // namespace demo
