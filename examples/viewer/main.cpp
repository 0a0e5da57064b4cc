/* SPDX-License-Identifier: MIT */
/*
 * raygrid-viewer: a window into a scene that moves.
 *
 *   viewer, controls   the loop; keys and the mouse     flight   the camera
 *   world, acts        what is in the scene             hand     what the user drags
 *   overlay            how the grid sees it             canvas   pixels
 *   window             SDL: window and text             script   events from a file
 *   meter              what frames take                 options  the command line
 *   ../common          what the demo does alike: glTF files, scene, rays, light, pictures
 */
#include "text.h"
#include "viewer.h"

#include <cstdio>

int main(int argc, char **argv) {
    try {
        const viewer::Options options = viewer::read_options(argc, argv);
        if (!options.help)
            viewer::Viewer(options).run();
        else
            std::fputs(viewer::usage().c_str(), stdout);
        return 0;
    } catch (const demo::UsageError &error) {
        std::fprintf(stderr, "raygrid-viewer: %s\n", demo::one_line(error.what()).c_str());
        return 2;
    } catch (const std::exception &error) {
        std::fprintf(stderr, "raygrid-viewer: %s\n", demo::one_line(error.what()).c_str());
        return 1;
    }
}
