/* SPDX-License-Identifier: MIT */
/* gltf_poses.cpp: prints, for each time given, the world transforms of a file's nodes, 16 numbers a node a line. */
#include "gltf_model.h"

#include <cstdio>
#include <cstdlib>

int main(int argc, char **argv) {
    if (argc < 3) return 2;
    const demo::Model model(argv[1], [](const std::string &note) { std::fprintf(stderr, "%s\n", note.c_str()); });
    for (int i = 2; i < argc; ++i)
        for (const Imath::M44d &matrix : model.transforms(std::atof(argv[i]))) {
            for (int row = 0; row < 4; ++row)
                for (int column = 0; column < 4; ++column) std::printf("%.17g ", matrix[row][column]);
            std::printf("\n");
        }
    return 0;
}
