/* SPDX-License-Identifier: MIT */
/*
 * raygrid-demo: a glTF scene taken apart and moving among spheres and boxes that come and go, rendered frame by
 * frame.
 *
 *   world            all that moves, and the ground below    swarm    spheres and boxes that drift
 *   path             of the camera
 *   verify           hits against brute force                report   the table
 *   ../common        what the viewer does alike: glTF files and their parts, scene, rays, light, pictures
 */
#include "path.h"
#include "report.h"
#include "text.h"

#include <cstdio>
#include <filesystem>

namespace demo {

namespace {

/* The ray through the centre of each pixel comes last, so that the check finds it in the pass. */
Pass::Cost render(const World &world, Renderer &renderer, const Options &options, double phase) {
    const Camera camera = camera_on_path(phase, options.width, options.height);
    Pass::Cost cost;
    renderer.restart();
    for (uint32_t number = options.samples; number-- > 0;)
        renderer.add(world.stage().scene(), world.looks(), camera, number, PassWants(), cost);
    return cost;
}

Frame render_frame(World &world, Renderer &renderer, const Options &options, double phase, Imath::Rand48 &random) {
    Frame frame = {};
    frame.update = world.advance();
    frame.cost = render(world, renderer, options, phase);
    frame.errors = verify(world.stage(), renderer.pass(), options.sample, random);
    rg_grid_report grid = {};
    grid.size = sizeof grid;
    check(rg_grid_stats(world.stage().scene(), RG_GRID_OF_SCENE, &grid));
    frame.objects = grid.objects;
    frame.rebuilds = grid.rebuilds;
    frame.tiles = grid.tiles;
    return frame;
}

std::string file_of(const Options &options, uint32_t frame, const char *extension) {
    char name[32];
    std::snprintf(name, sizeof name, "frame-%04u.%s", unsigned(frame), extension);
    return (std::filesystem::path(options.out) / name).string();
}

int run(const Options &options) {
    Report report(options);
    const Notes notes = [&report](const std::string &text) { report.note(text); };
    std::unique_ptr<Model> model;
    std::unique_ptr<World> world;
    try {
        model = std::make_unique<Model>(options.gltf, notes);
        world = std::make_unique<World>(*model, options, notes);
    } catch (const std::exception &error) {
        throw std::runtime_error(options.gltf + ": " + error.what());
    }
    std::filesystem::create_directories(options.out);
    Crew crew(options.workers);
    Renderer renderer(options.width, options.height, crew);
    ContactSheet sheet(options.frames);
    Imath::Rand48 random(static_cast<unsigned long>(options.seed + 2000));
    for (uint32_t f = 0; f < options.frames; ++f) {
        report.add(render_frame(*world, renderer, options, double(f) / options.frames, random));
        write_exr(file_of(options, f, "exr"), renderer.picture());
        if (options.stills) write_png(file_of(options, f, "png"), renderer.picture());
        sheet.add(renderer.picture());
    }
    const std::string contact = (std::filesystem::path(options.out) / "contact.png").string();
    sheet.write(contact);
    report.finish(options.out);
    return report.wrong() == 0 ? 0 : 1;
}

} // namespace

} // namespace demo

int main(int argc, char **argv) {
    try {
        const demo::Options options = demo::read_options(argc, argv);
        if (!options.help) return demo::run(options);
        std::fputs(demo::usage().c_str(), stdout);
        return 0;
    } catch (const demo::UsageError &error) {
        std::fprintf(stderr, "raygrid-demo: %s\n", demo::one_line(error.what()).c_str());
        return 2;
    } catch (const std::exception &error) {
        std::fprintf(stderr, "raygrid-demo: %s\n", demo::one_line(error.what()).c_str());
        return 1;
    }
}
