/* SPDX-License-Identifier: MIT */
#include "gltf_file.h"

#include "gltf_check.h"

#include <cerrno>
#include <climits>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace demo {

namespace {

/* Pictures are not used, so that a missing or broken one is no fault. */
bool skip_image(tinygltf::Image *, const int, std::string *, std::string *, int, int, const unsigned char *, int,
                void *) {
    return true;
}

/* Files beside the .gltf. tinygltf's own reader takes a directory for a file of 2^63 bytes. */
bool read_beside(std::vector<unsigned char> *out, std::string *error, const std::string &path, void *) {
    std::ifstream file(path, std::ios::binary);
    if (!std::filesystem::is_regular_file(path) || !file) {
        *error += "can't read '" + path + "'";
        return false;
    }
    out->assign(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    return true;
}

std::string read_whole(const std::string &path) {
    if (std::filesystem::is_directory(path)) throw std::runtime_error("is a directory");
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error(std::string("can't be opened: ") + std::strerror(errno));
    std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    if (bytes.size() >= size_t(INT_MAX)) throw std::runtime_error("is larger than 2 GiB");
    if (bytes.empty()) throw std::runtime_error("is empty");
    return bytes;
}

uint32_t little_endian(const std::string &bytes, size_t at) {
    uint32_t value = 0;
    for (size_t i = 4; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
}

/* A .glb starts with "glTF", version, length; then the first chunk: its length, "JSON", the text. */
std::pair<size_t, size_t> json_range(const std::string &bytes, bool binary) {
    if (!binary) return {0, bytes.size()};
    if (bytes.size() < 20) throw std::runtime_error("ends within the header of a .glb file");
    if (little_endian(bytes, 4) != 2)
        throw std::runtime_error("is glTF of version " + std::to_string(little_endian(bytes, 4)) + ", not 2");
    const size_t length = little_endian(bytes, 12);
    if (bytes.compare(16, 4, "JSON") != 0) throw std::runtime_error("has no JSON in its first chunk");
    if (little_endian(bytes, 8) > bytes.size() || length > bytes.size() - 20)
        throw std::runtime_error("is cut short: its header promises more bytes than it has");
    return {20, length};
}

tinygltf::Model parse(const std::string &bytes, bool binary, const std::string &directory, const Notes &notes) {
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(skip_image, nullptr);
    loader.SetFsCallbacks({tinygltf::FileExists, tinygltf::ExpandFilePath, read_beside, nullptr, nullptr});
    tinygltf::Model model;
    std::string error, warning;
    const unsigned size = static_cast<unsigned>(bytes.size());
    const auto *data = reinterpret_cast<const unsigned char *>(bytes.data());
    const bool ok = binary ? loader.LoadBinaryFromMemory(&model, &error, &warning, data, size, directory)
                           : loader.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size, directory);
    /* tinygltf goes on after some of its errors: a file with any is broken all the same. */
    if (!ok || !error.empty()) throw std::runtime_error(error.empty() ? "can't be parsed" : error);
    if (!warning.empty()) notes(warning);
    return model;
}

} // namespace

tinygltf::Model load_gltf(const std::string &path, const Notes &notes) {
    const std::string bytes = read_whole(path);
    const bool binary = bytes.compare(0, 4, "glTF") == 0;
    const auto [start, length] = json_range(bytes, binary);
    check_gltf_json(bytes.data() + start, length);

    const std::string directory = std::filesystem::path(path).parent_path().string();
    return parse(bytes, binary, directory, notes);
}

} // namespace demo
