/* SPDX-License-Identifier: MIT */
#include "options.h"

#include <algorithm>
#include <getopt.h>
#include <sstream>

namespace viewer {

using namespace demo;

namespace {

enum Flag : int {
    FLAKE = 256,
    SPHERES,
    MOVING,
    SIZE,
    WORKERS,
    GRID,
    RESOLUTION,
    SEED,
    FRAMES,
    SAMPLES,
    TIME,
    PAUSED,
    FIXED,
    NO_WINDOW,
    REPORT,
    EYE,
    TARGET,
    SHOW,
    SCRIPT,
    SHOT,
    FONT,
    HELP
};

const option flags[] = {
    {"flake", required_argument, nullptr, FLAKE},
    {"spheres", required_argument, nullptr, SPHERES},
    {"moving", required_argument, nullptr, MOVING},
    {"size", required_argument, nullptr, SIZE},
    {"workers", required_argument, nullptr, WORKERS},
    {"grid", required_argument, nullptr, GRID},
    {"resolution", required_argument, nullptr, RESOLUTION},
    {"seed", required_argument, nullptr, SEED},
    {"frames", required_argument, nullptr, FRAMES},
    {"samples", required_argument, nullptr, SAMPLES},
    {"time", required_argument, nullptr, TIME},
    {"paused", no_argument, nullptr, PAUSED},
    {"fixed", no_argument, nullptr, FIXED},
    {"no-window", no_argument, nullptr, NO_WINDOW},
    {"report", no_argument, nullptr, REPORT},
    {"eye", required_argument, nullptr, EYE},
    {"target", required_argument, nullptr, TARGET},
    {"show", required_argument, nullptr, SHOW},
    {"script", required_argument, nullptr, SCRIPT},
    {"shot", required_argument, nullptr, SHOT},
    {"font", required_argument, nullptr, FONT},
    {"help", no_argument, nullptr, HELP},
    {nullptr, 0, nullptr, 0},
};

std::vector<std::string> split(const std::string &text) {
    std::vector<std::string> words;
    std::istringstream stream(text);
    for (std::string word; std::getline(stream, word, ',');) words.push_back(word);
    return words;
}

std::vector<double> read_place(const char *name, const std::string &text) {
    std::vector<double> place;
    for (const std::string &word : split(text)) place.push_back(read_real(name, word, -1e6, 1e6));
    if (place.size() != 3) throw UsageError("--" + std::string(name) + " wants X,Y,Z, not '" + text + "'");
    return place;
}

struct OverlayWord {
    const char *word;
    bool Overlays::*overlay;
};
const OverlayWord overlay_words[] = {
    {"boxes", &Overlays::boxes}, {"cells", &Overlays::cells}, {"levels", &Overlays::levels},
    {"heat", &Overlays::heat},   {"text", &Overlays::text},   {"legend", &Overlays::legend},
    {"help", &Overlays::help},
};

Overlays read_overlays(const std::string &text) {
    Overlays overlays;
    overlays.text = overlays.legend = false;
    for (const std::string &word : split(text)) {
        const auto found = std::find_if(std::begin(overlay_words), std::end(overlay_words),
                                        [&word](const OverlayWord &known) { return word == known.word; });
        if (found != std::end(overlay_words))
            overlays.*found->overlay = true;
        else if (word != "none")
            throw UsageError("--show wants boxes, cells, levels, heat, text, legend, help or none, not '" + word +
                             "'");
    }
    return overlays;
}

/* What is shown and how it moves. */
bool read_world_option(int flag, const std::string &text, Options &options) {
    switch (flag) {
    case FLAKE:
        options.flake = read_count("flake", text, 0, 7);
        return true;
    case SPHERES:
        options.spheres = read_count("spheres", text, 1, 10000000);
        return true;
    case MOVING:
        options.moving = read_real("moving", text, 0, 1);
        return true;
    case WORKERS:
        options.workers = read_count("workers", text, 0, 1024);
        return true;
    case GRID:
        options.grid = read_grid_kind("grid", text);
        return true;
    case RESOLUTION:
        options.resolution = read_count("resolution", text, 0, 512);
        return true;
    case SEED:
        options.seed = read_number("seed", text, 0, UINT64_MAX);
        return true;
    case TIME:
        options.time = read_real("time", text, 0, 1e6);
        return true;
    case PAUSED:
        options.paused = true;
        return true;
    case FIXED:
        options.fixed = true;
        return true;
    default:
        return false;
    }
}

void read_option(int flag, const std::string &text, Options &options) {
    switch (flag) {
    case SIZE:
        read_size("size", text, options.width, options.height);
        break;
    case FRAMES:
        options.frames = read_count("frames", text, 1, 1000000);
        break;
    case SAMPLES:
        options.samples = read_count("samples", text, 1, 65536);
        break;
    case NO_WINDOW:
        options.window = false;
        break;
    case REPORT:
        options.report = true;
        break;
    case EYE:
        options.eye = read_place("eye", text);
        break;
    case TARGET:
        options.target = read_place("target", text);
        break;
    case SHOW:
        options.overlays = read_overlays(text);
        break;
    case SCRIPT:
        options.script = text;
        break;
    case SHOT:
        options.shots.push_back(text);
        break;
    case FONT:
        options.font = text;
        break;
    case HELP:
        options.help = true;
        break;
    default:
        throw UsageError("unknown option, or one without its value; --help lists all");
    }
}

void check_together(const Options &options) {
    if (options.frames > 0) return;
    if (!options.shots.empty()) throw UsageError("--shot is of the last frame, so --frames must say which that is");
    if (!options.window) throw UsageError("--no-window wants --frames, or it would never end");
}

} // namespace

Options read_options(int argc, char **argv) {
    Options options;
    opterr = 0; /* the message is ours */
    for (int flag = 0; (flag = getopt_long(argc, argv, "", flags, nullptr)) != -1;) {
        const std::string text = optarg ? optarg : "";
        if (!read_world_option(flag, text, options)) read_option(flag, text, options);
    }
    if (optind < argc) options.gltf = argv[optind++];
    if (optind < argc)
        throw UsageError("one file is expected, but there is '" + std::string(argv[optind]) + "', too");
    if (!options.help) check_together(options);
    return options;
}

std::string usage() {
    return "usage: raygrid-viewer [options] [FILE]\n"
           "A window into a scene that moves: fly through it, drag what is in it, and see how its grid sees it.\n"
           "FILE is a glTF 2 file, .gltf or .glb; without one a sphere flake flies apart and comes together.\n\n"
           "what is shown\n"
           "  --flake N          generations of the sphere flake, 9^N spheres in the last (4)\n"
           "  --spheres N        N spheres in a cube in place of the flake\n"
           "  --moving SHARE     of those that move in each frame (0.1)\n"
           "  --seed N           of all that is random (1)\n"
           "  --time SECONDS     of the animation at the first frame (0)\n"
           "  --paused           the animation rests, until space is pressed\n"
           "  --eye X,Y,Z        where the camera is      --target X,Y,Z  what it looks at\n"
           "  --show LIST        boxes,cells,levels,heat,text,legend,help or none (text,legend)\n\n"
           "how\n"
           "  --size WxH         pixels of the window (512x512)\n"
           "  --workers N        threads that trace; 0: one a processor (0)\n"
           "  --grid KIND        uniform, hierarchical, loose or default\n"
           "  --resolution N     cells of the grid along its longest side, for kinds that have one; 0: automatic "
           "(0)\n"
           "  --samples N        rays a pixel, gathered while nothing moves (256)\n"
           "  --font FILE        of the text on the screen (DejaVu Sans Mono, where Debian has it)\n\n"
           "without a hand on it\n"
           "  --frames N         ends after N frames\n"
           "  --fixed            each frame is a sixtieth of a second of the animation, however long it took\n"
           "  --no-window        draws as ever, but nowhere\n"
           "  --report           in the end tells the frames a second and what they were spent on\n"
           "  --shot FILE        writes the last frame: .png as on the screen, .exr its light; more than one may be "
           "given\n"
           "  --script FILE      keys and the mouse at given frames: see examples/viewer/README.md\n"
           "  --help             this text\n\n"
           "Exit code: 0; 1 if a file can't be used or there is no screen; 2 for a bad command line.\n";
}

} // namespace viewer
