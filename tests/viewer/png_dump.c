/* SPDX-License-Identifier: MIT */
/* png_dump.c: prints a PNG as a binary PPM: its width and height in words, then R, G, B of each pixel. */
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int main(int argc, char **argv) {
    png_image image;
    png_byte *pixels;
    int failed;

    if (argc != 2) return 2;
    memset(&image, 0, sizeof image);
    image.version = PNG_IMAGE_VERSION;
    if (!png_image_begin_read_from_file(&image, argv[1])) {
        fprintf(stderr, "png_dump: %s: %s\n", argv[1], image.message);
        return 1;
    }
    image.format = PNG_FORMAT_RGB;
    pixels = malloc(PNG_IMAGE_SIZE(image));
    failed = !pixels || !png_image_finish_read(&image, NULL, pixels, 0, NULL);
    if (failed) {
        fprintf(stderr, "png_dump: %s: %s\n", argv[1], pixels ? image.message : "no memory");
        png_image_free(&image);
    } else {
        printf("P6\n%u %u\n255\n", (unsigned)image.width, (unsigned)image.height);
        failed = fwrite(pixels, PNG_IMAGE_SIZE(image), 1, stdout) != 1;
    }
    free(pixels);
    return failed;
}
