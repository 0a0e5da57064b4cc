/* SPDX-License-Identifier: MIT */
#include "options.h"

#include <getopt.h>

namespace demo {

namespace {

enum Flag : int {
    GLTF = 256,
    FRAMES,
    SIZE,
    OUT,
    SPHERES,
    BOXES,
    WORKERS,
    GRID,
    SAMPLE,
    SAMPLES,
    SEED,
    STILLS,
    QUIET,
    HELP
};

const option flags[] = {
    {"gltf", required_argument, nullptr, GLTF},
    {"frames", required_argument, nullptr, FRAMES},
    {"size", required_argument, nullptr, SIZE},
    {"out", required_argument, nullptr, OUT},
    {"spheres", required_argument, nullptr, SPHERES},
    {"boxes", required_argument, nullptr, BOXES},
    {"workers", required_argument, nullptr, WORKERS},
    {"grid", required_argument, nullptr, GRID},
    {"sample", required_argument, nullptr, SAMPLE},
    {"samples", required_argument, nullptr, SAMPLES},
    {"seed", required_argument, nullptr, SEED},
    {"stills", no_argument, nullptr, STILLS},
    {"quiet", no_argument, nullptr, QUIET},
    {"help", no_argument, nullptr, HELP},
    {nullptr, 0, nullptr, 0},
};

void read_option(int flag, const std::string &text, Options &options) {
    switch (flag) {
    case GLTF:
        options.gltf = text;
        break;
    case FRAMES:
        options.frames = read_count("frames", text, 1, 1000);
        break;
    case SIZE:
        read_size("size", text, options.width, options.height);
        break;
    case OUT:
        options.out = text;
        break;
    case SPHERES:
        options.spheres = read_count("spheres", text, 0, 10000000);
        break;
    case BOXES:
        options.boxes = read_count("boxes", text, 0, 10000000);
        break;
    case WORKERS:
        options.workers = read_count("workers", text, 0, 1024);
        break;
    case GRID:
        options.grid = read_grid_kind("grid", text);
        break;
    case SAMPLE:
        options.sample = read_count("sample", text, 0, 1000000);
        break;
    case SAMPLES:
        options.samples = read_count("samples", text, 1, 256);
        break;
    case SEED:
        options.seed = read_number("seed", text, 0, UINT64_MAX);
        break;
    case STILLS:
        options.stills = true;
        break;
    case QUIET:
        options.quiet = true;
        break;
    case HELP:
        options.help = true;
        break;
    default:
        throw UsageError("unknown option, or one without its value; --help lists all");
    }
}

} // namespace

Options read_options(int argc, char **argv) {
    Options options;
    opterr = 0; /* the message is ours */
    for (int flag = 0; (flag = getopt_long(argc, argv, "", flags, nullptr)) != -1;)
        read_option(flag, optarg ? optarg : "", options);
    if (optind < argc) throw UsageError("no argument is expected, but there is '" + std::string(argv[optind]) + "'");
    return options;
}

std::string usage() {
    const Options normal;
    const auto text = [](auto value) { return std::to_string(value); };
    return "usage: raygrid-demo [options]\n"
           "Renders a glTF scene, taken apart and moving among spheres and boxes, into OpenEXR frames and one PNG\n"
           "contact sheet, and checks a sample of the rays of each frame against brute force.\n\n"
           "  --gltf FILE        a glTF 2 file, .gltf or .glb (" +
           normal.gltf +
           ")\n"
           "  --frames N         frames to render (" +
           text(normal.frames) +
           ")\n"
           "  --size WxH         pixels of a frame (" +
           text(normal.width) + "x" + text(normal.height) +
           ")\n"
           "  --out DIR          where the pictures go; made if it is not there (" +
           normal.out +
           ")\n"
           "  --spheres N        drifting spheres (" +
           text(normal.spheres) +
           ")\n"
           "  --boxes N          drifting boxes (" +
           text(normal.boxes) +
           ")\n"
           "  --workers N        threads that trace; 0: one a processor (" +
           text(normal.workers) +
           ")\n"
           "  --grid KIND        uniform, hierarchical, loose or default\n"
           "  --samples N        primary rays a pixel (" +
           text(normal.samples) +
           ")\n"
           "  --sample N         rays of each frame checked against brute force (" +
           text(normal.sample) +
           ")\n"
           "  --seed N           of all that is random (" +
           text(normal.seed) +
           ")\n"
           "  --stills           also write each frame as PNG\n"
           "  --quiet            no progress and no table, only the summary\n"
           "  --help             this text\n\n"
           "Exit code: 0 if no checked ray was wrong, 1 otherwise or if the file can't be used, 2 for a bad command "
           "line.\n";
}

} // namespace demo
