/* SPDX-License-Identifier: MIT */
/* options.h: what the command line of the viewer says. */
#ifndef VIEWER_OPTIONS_H
#define VIEWER_OPTIONS_H

#include "arguments.h"

#include <optional>
#include <vector>

namespace viewer {

/** What is drawn over the picture. */
struct Overlays {
    bool boxes = false;  /* the physical and the logical box of the grid */
    bool cells = false;  /* walls of its cells, where they cut through what is seen */
    bool levels = false; /* the level at which each object is listed */
    bool heat = false;   /* cells that the ray of each pixel looked into */
    bool text = true;    /* times and counts */
    bool legend = true;  /* what the colours of the others mean */
    bool help = false;   /* the keys */
};

struct Options {
    std::string gltf;     /* a file to show; "": the flake or the field */
    uint32_t flake = 4;   /* generations of the sphere flake */
    uint32_t spheres = 0; /* of the field in place of the flake; 0: the flake */
    double moving = 0.1;  /* share of the field that moves */
    uint32_t width = 512, height = 512;
    uint32_t workers = 0; /* 0: one a processor */
    rg_grid_kind grid = RG_GRID_DEFAULT;
    uint32_t resolution = 0; /* 0: automatic */
    uint64_t seed = 1;
    uint32_t frames = 0;    /* 0: until the window is closed */
    uint32_t samples = 256; /* a pixel, when nothing moves */
    double time = 0;        /* seconds of the animation at which it begins */
    bool paused = false;
    bool fixed = false; /* each frame is a sixtieth of a second, whatever it took */
    bool window = true;
    bool report = false;
    std::optional<std::vector<double>> eye, target;
    Overlays overlays;
    std::string script;
    std::vector<std::string> shots; /* files that the last frame is written to */
    std::string font = "/usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf";
    bool help = false;
};

/** Throws demo::UsageError. */
Options read_options(int argc, char **argv);

/** The text of --help. */
std::string usage();

} // namespace viewer

#endif
