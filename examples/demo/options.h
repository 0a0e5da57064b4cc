/* SPDX-License-Identifier: MIT */
/* options.h: what the command line of the demo says. */
#ifndef DEMO_OPTIONS_H
#define DEMO_OPTIONS_H

#include "arguments.h"

namespace demo {

struct Options {
    std::string gltf = "/usr/share/assimp/models/glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb";
    std::string out = "demo-out";
    uint32_t frames = 36;
    uint32_t width = 512, height = 512;
    uint32_t spheres = 2500, boxes = 1500;
    uint32_t workers = 0; /* 0: one a processor */
    uint32_t samples = 3; /* rays a pixel */
    uint32_t sample = 64; /* rays checked against brute force, each frame */
    uint64_t seed = 1;
    rg_grid_kind grid = RG_GRID_DEFAULT;
    bool stills = false;
    bool quiet = false;
    bool help = false;
};

/** Throws UsageError. */
Options read_options(int argc, char **argv);

/** The text of --help. */
std::string usage();

} // namespace demo

#endif
