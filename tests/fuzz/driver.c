/* SPDX-License-Identifier: MIT */
/*
 * driver.c: the fuzzer's entry as an ordinary test.
 *
 *   fuzz_driver [--seed S] [--random N] [--one S] [--all DIRECTORY] [file ...]
 *
 * Runs each file's bytes, then N random scripts: those of the numbers from the seed on. After a crash the last line
 * printed names the file, or the hundred of numbers, that it was in; --one S runs the script of that number alone.
 */
#define _POSIX_C_SOURCE 200809L /* scandir */

#include "random.h"

#include <dirent.h>
#include <inttypes.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LONGEST = 2048 };

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

static void run_file(const char *path) {
    static uint8_t bytes[1 << 16];
    FILE *file = fopen(path, "rb");
    if (!file) {
        perror(path);
        exit(EXIT_FAILURE);
    }
    size_t size = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    fprintf(stderr, "file %s\n", path);
    LLVMFuzzerTestOneInput(bytes, size);
}

static int is_no_dot_file(const struct dirent *entry) {
    return entry->d_name[0] != '.';
}

static void run_directory(const char *path) {
    struct dirent **entries;
    int count = scandir(path, &entries, is_no_dot_file, alphasort);
    if (count < 0) {
        perror(path);
        exit(EXIT_FAILURE);
    }
    for (int i = 0; i < count; i++) {
        char name[4096];
        snprintf(name, sizeof name, "%s/%s", path, entries[i]->d_name);
        run_file(name);
        free(entries[i]);
    }
    free(entries);
    printf("%d files\n", count);
}

/* Small bytes are the common calls and numbers; so half of the scripts have mostly those. */
static void run_random(uint64_t number) {
    random_source r = {number};
    uint8_t bytes[LONGEST];
    size_t size = random_below(&r, LONGEST);
    bool tame = random_once_in(&r, 2);
    for (size_t i = 0; i < size; i++) {
        bytes[i] = (uint8_t)random_below(&r, tame && !random_once_in(&r, 8) ? 100 : 256);
    }
    LLVMFuzzerTestOneInput(bytes, size);
}

int main(int argc, char **argv) {
    uint64_t seed = 20004, count = 20000;
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--seed") == 0 && i + 1 < argc) {
            seed = strtoull(argv[++i], NULL, 0);
        } else if (strcmp(argv[i], "--random") == 0 && i + 1 < argc) {
            count = strtoull(argv[++i], NULL, 0);
        } else if (strcmp(argv[i], "--one") == 0 && i + 1 < argc) {
            run_random(strtoull(argv[++i], NULL, 0));
            return EXIT_SUCCESS;
        } else if (strcmp(argv[i], "--all") == 0 && i + 1 < argc) {
            run_directory(argv[++i]);
        } else {
            run_file(argv[i]);
        }
    }
    printf("seed %" PRIu64 "\n", seed);
    for (uint64_t i = 0; i < count; i++) {
        if (i % 100 == 0) fprintf(stderr, "from %" PRIu64 "\n", seed + i);
        run_random(seed + i);
    }
    printf("%" PRIu64 " random scripts, none failed\n", count);
    return EXIT_SUCCESS;
}
