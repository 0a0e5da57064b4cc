/* SPDX-License-Identifier: MIT */
/*
 * exr_dump.c: reads an OpenEXR file back by OpenEXRCore, all of its pixels, and prints what is in it as JSON: size,
 * compression, and for each channel its type and values, those as floats (half, float) or integers (uint).
 */
#include <math.h>
#include <openexr.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CHANNELS = 8 };

typedef struct plane {
    char name[32];
    exr_pixel_type_t type;
    uint32_t *values; /* floats by their bits */
} plane;

static void need(exr_result_t result) {
    if (result == EXR_ERR_SUCCESS) return;
    fprintf(stderr, "exr_dump: %s\n", exr_get_default_error_message(result));
    exit(1);
}

static void target(exr_decode_pipeline_t *decoder, plane *planes, int y, int width) {
    for (int c = 0; c < decoder->channel_count; c++) {
        exr_coding_channel_info_t *from = &decoder->channels[c];
        from->decode_to_ptr = (uint8_t *)(planes[c].values + (size_t)y * (size_t)width);
        from->user_data_type = (uint16_t)(planes[c].type == EXR_PIXEL_UINT ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT);
        from->user_bytes_per_element = 4;
        from->user_pixel_stride = 4;
        from->user_line_stride = 4 * width;
    }
}

static void read_pixels(exr_context_t file, plane *planes, int width, int height) {
    exr_decode_pipeline_t decoder = EXR_DECODE_PIPELINE_INITIALIZER;
    int32_t rows;
    need(exr_get_scanlines_per_chunk(file, 0, &rows));
    for (int y = 0; y < height; y += rows) {
        exr_chunk_info_t chunk;
        need(exr_read_scanline_chunk_info(file, 0, y, &chunk));
        need(y == 0 ? exr_decoding_initialize(file, 0, &chunk, &decoder)
                    : exr_decoding_update(file, 0, &chunk, &decoder));
        target(&decoder, planes, y, width);
        if (y == 0) need(exr_decoding_choose_default_routines(file, 0, &decoder));
        need(exr_decoding_run(file, 0, &decoder));
    }
    need(exr_decoding_destroy(file, &decoder));
}

static void print_value(const plane *channel, size_t pixel) {
    float number;
    memcpy(&number, &channel->values[pixel], sizeof number);
    if (channel->type == EXR_PIXEL_UINT)
        printf("%lu", (unsigned long)channel->values[pixel]);
    else if (isfinite(number))
        printf("%.9g", (double)number);
    else
        printf("%s", isnan(number) ? "NaN" : number > 0 ? "Infinity" : "-Infinity");
}

static void print_channel(const plane *channel, size_t pixels) {
    static const char *const types[] = {"uint", "half", "float"};
    printf("\"%s\": {\"type\": \"%s\", \"values\": [", channel->name, types[channel->type]);
    for (size_t pixel = 0; pixel < pixels; pixel++) {
        if (pixel > 0) printf(", ");
        print_value(channel, pixel);
    }
    printf("]}");
}

int main(int argc, char **argv) {
    if (argc != 2) return 2;
    exr_context_t file;
    need(exr_start_read(&file, argv[1], NULL));
    exr_attr_box2i_t window;
    exr_compression_t compression;
    const exr_attr_chlist_t *channels;
    need(exr_get_data_window(file, 0, &window));
    need(exr_get_compression(file, 0, &compression));
    need(exr_get_channels(file, 0, &channels));
    if (channels->num_channels > CHANNELS) return 2;

    const int width = window.max.x - window.min.x + 1, height = window.max.y - window.min.y + 1;
    const size_t pixels = (size_t)width * (size_t)height;
    plane planes[CHANNELS] = {0};
    for (int c = 0; c < channels->num_channels; c++) {
        snprintf(planes[c].name, sizeof planes[c].name, "%s", channels->entries[c].name.str);
        planes[c].type = channels->entries[c].pixel_type;
        planes[c].values = calloc(pixels, sizeof *planes[c].values);
        if (!planes[c].values) return 2;
    }
    read_pixels(file, planes, width, height);

    printf("{\"width\": %d, \"height\": %d, \"compression\": %d, \"channels\": {", width, height, (int)compression);
    for (int c = 0; c < channels->num_channels; c++) {
        if (c > 0) printf(", ");
        print_channel(&planes[c], pixels);
        free(planes[c].values);
    }
    printf("}}\n");
    need(exr_finish(&file));
    return 0;
}
