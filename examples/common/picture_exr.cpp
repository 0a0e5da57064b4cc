/* SPDX-License-Identifier: MIT */
#include "picture.h"

#include <openexr.h>
#include <stdexcept>

namespace demo {

namespace {

struct ExrChannel {
    const char *name;
    exr_pixel_type_t stored, given;
    const void *data;
    size_t stride; /* bytes from pixel to pixel */
};

class ExrFile {
  public:
    explicit ExrFile(const std::string &path) : path_(path) {
        exr_context_initializer_t settings = EXR_DEFAULT_CONTEXT_INITIALIZER;
        settings.error_handler_fn = [](exr_const_context_t, exr_result_t, const char *) {}; /* we throw instead */
        check(exr_start_write(&context_, path.c_str(), EXR_INTERMEDIATE_TEMP_FILE, &settings));
    }
    ~ExrFile() {
        if (coding_) exr_encoding_destroy(context_, &encoder_);
        if (context_) exr_finish(&context_);
    }
    ExrFile(const ExrFile &) = delete;
    ExrFile &operator=(const ExrFile &) = delete;

    void describe(const Picture &picture, const std::vector<ExrChannel> &channels) {
        check(exr_add_part(context_, nullptr, EXR_STORAGE_SCANLINE, &part_));
        check(exr_initialize_required_attr_simple(context_, part_, int32_t(picture.width), int32_t(picture.height),
                                                  EXR_COMPRESSION_ZIP));
        for (const ExrChannel &channel : channels)
            check(exr_add_channel(context_, part_, channel.name, channel.stored, EXR_PERCEPTUALLY_LINEAR, 1, 1));
        check(exr_write_header(context_));
    }

    void write(const Picture &picture, const std::vector<ExrChannel> &channels) {
        int32_t rows = 0; /* of a compressed chunk */
        check(exr_get_scanlines_per_chunk(context_, part_, &rows));
        for (int32_t y = 0; y < int32_t(picture.height); y += rows) write_chunk(y, picture.width, channels);
    }

    /* The file gets its name only now, when all went well. */
    void finish() {
        exr_encoding_destroy(context_, &encoder_);
        coding_ = false;
        check(exr_finish(&context_));
    }

  private:
    void check(exr_result_t result) const {
        if (result != EXR_ERR_SUCCESS)
            throw std::runtime_error("can't write '" + path_ + "': " + exr_get_default_error_message(result));
    }

    void write_chunk(int32_t y, uint32_t width, const std::vector<ExrChannel> &channels) {
        exr_chunk_info_t chunk;
        check(exr_write_scanline_chunk_info(context_, part_, y, &chunk));
        check(coding_ ? exr_encoding_update(context_, part_, &chunk, &encoder_)
                      : exr_encoding_initialize(context_, part_, &chunk, &encoder_));
        for (int c = 0; c < encoder_.channel_count; ++c) {
            exr_coding_channel_info_t &to = encoder_.channels[c];
            for (const ExrChannel &channel : channels) {
                if (std::string(channel.name) != to.channel_name) continue;
                const auto *first = static_cast<const uint8_t *>(channel.data);
                to.encode_from_ptr = first + size_t(y) * width * channel.stride;
                to.user_data_type = uint16_t(channel.given);
                to.user_bytes_per_element = 4;
                to.user_pixel_stride = int32_t(channel.stride);
                to.user_line_stride = int32_t(width * channel.stride);
            }
        }
        if (!coding_) check(exr_encoding_choose_default_routines(context_, part_, &encoder_));
        coding_ = true;
        check(exr_encoding_run(context_, part_, &encoder_));
    }

    std::string path_;
    exr_context_t context_ = nullptr;
    int part_ = 0;
    exr_encode_pipeline_t encoder_ = {};
    bool coding_ = false;
};

} // namespace

void write_exr(const std::string &path, const Picture &picture) {
    const size_t pixel = sizeof(Imath::V3f);
    const std::vector<ExrChannel> channels = {
        {"B", EXR_PIXEL_HALF, EXR_PIXEL_FLOAT, &picture.colour[0].z, pixel},
        {"G", EXR_PIXEL_HALF, EXR_PIXEL_FLOAT, &picture.colour[0].y, pixel},
        {"R", EXR_PIXEL_HALF, EXR_PIXEL_FLOAT, &picture.colour[0].x, pixel},
        {"Z", EXR_PIXEL_FLOAT, EXR_PIXEL_FLOAT, picture.depth.data(), sizeof(float)},
        {"id", EXR_PIXEL_UINT, EXR_PIXEL_UINT, picture.id.data(), sizeof(uint32_t)},
    };
    ExrFile file(path);
    file.describe(picture, channels);
    file.write(picture, channels);
    file.finish();
}

} // namespace demo
