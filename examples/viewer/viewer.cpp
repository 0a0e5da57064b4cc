/* SPDX-License-Identifier: MIT */
#include "viewer.h"

#include "text.h"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <thread>

namespace viewer {

using namespace demo;
using Imath::V3d;

namespace {

constexpr double fixed_seconds = 1.0 / 60;
constexpr double longest_step = 0.1; /* seconds: after a halt nothing jumps */
constexpr int letter_size = 13;      /* points */

V3d place_of(const std::optional<std::vector<double>> &given, const V3d &usual) {
    return given ? V3d((*given)[0], (*given)[1], (*given)[2]) : usual;
}

void note(const std::string &text) {
    std::fprintf(stderr, "raygrid-viewer: note: %s\n", one_line(text).c_str());
}

uint32_t workers_of(const Options &options) {
    return options.workers > 0 ? options.workers : std::max(1u, std::thread::hardware_concurrency());
}

const char *const keys[] = {
    "W A S D fly, E Q up and down, shift: faster",    "left button drags, wheel: nearer, farther",
    "right button turns, home: camera back",          "I inserts a ball, B a box, X removes",
    "G kind of grid, [ ] its resolution, R rebuilds", "1 boxes, 2 cells, 3 levels, 4 heat, T text",
    "space pauses, P saves PNG, O EXR, esc ends",
};

/* What the frames take and what the grid holds. */
std::vector<std::string> status(const FrameTimes &times, const rg_grid_report &grid) {
    static const char *const names[] = {"default", "uniform", "hierarchical", "loose"};
    char lines[3][160];
    std::snprintf(lines[0], sizeof lines[0], "%5.1f ms a frame, %.0f/s", 1e3 * times.all,
                  times.all > 0 ? 1 / times.all : 0.0);
    std::snprintf(lines[1], sizeof lines[1], "%5.2f ms update, %.1f + %.1f ms rays", 1e3 * times.update,
                  1e3 * times.primary, 1e3 * times.sun);
    char cells[64] = "";
    if (grid.resolution[0] > 0)
        std::snprintf(cells, sizeof cells, " %ux%ux%u", unsigned(grid.resolution[0]), unsigned(grid.resolution[1]),
                      unsigned(grid.resolution[2]));
    std::snprintf(lines[2], sizeof lines[2], "%llu objects, %s%s, rebuilt %llux",
                  static_cast<unsigned long long>(grid.objects), names[grid.kind], cells,
                  static_cast<unsigned long long>(grid.rebuilds));
    return {lines[0], lines[1], lines[2]};
}

} // namespace

Viewer::Viewer(const Options &options)
    : options_(options), workers_(workers_of(options)),
      window_("raygrid viewer", options.width, options.height, options.window), letters_(options.font, letter_size),
      script_(options.script.empty() ? Script() : Script(options.script)), crew_(workers_), world_(options, note),
      flight_(place_of(options.eye, V3d(2.4, 0.9, 3.6)), place_of(options.target, V3d(0, -0.1, 0))),
      overlays_(options.overlays), overlay_(crew_), canvas_(options.width, options.height),
      renderer_(std::make_unique<Renderer>(options.width, options.height, crew_)), time_(options.time),
      paused_(options.paused), kind_(world_.grid().kind), resolution_(options.resolution) {
    world_.take_seconds();
}

void Viewer::run() {
    for (uint32_t number = 0; !quit_ && (options_.frames == 0 || number < options_.frames); ++number) {
        frame(number);
        if (options_.frames == 0 && is_at_rest()) SDL_WaitEventTimeout(nullptr, 100);
    }
    if (!options_.report) return;
    std::fputs(meter_.report(canvas_.width(), canvas_.height(), workers_).c_str(), stdout);
}

void Viewer::frame(uint32_t number) {
    const double begin = clock_.seconds();
    const double seconds = options_.fixed ? fixed_seconds : std::min(begin - last_, longest_step);
    last_ = begin;
    const std::clock_t processor = std::clock();
    FrameTimes times;
    script_.play(number, shots_);
    if (number + 1 == options_.frames) shots_.insert(shots_.end(), options_.shots.begin(), options_.shots.end());
    handle_events();
    resize();
    step(seconds);
    times.update = world_.take_seconds();
    trace(times);
    draw();
    window_.show(canvas_);
    times.all = clock_.seconds() - begin;
    times.processor = double(std::clock() - processor) / CLOCKS_PER_SEC;
    if (times.rays > 0) meter_.add(times);
    write_shots();
}

/* -------------------------------------------------------------------------------------------- the picture */

void Viewer::resize() {
    const uint32_t width = std::clamp(window_.width(), 1u, 4096u), height = std::clamp(window_.height(), 1u, 4096u);
    if (width == canvas_.width() && height == canvas_.height()) return;
    canvas_ = Canvas(width, height);
    renderer_ = std::make_unique<Renderer>(width, height, crew_);
    edited_ = true;
}

void Viewer::step(double seconds) {
    if (!paused_) {
        time_ += seconds;
        world_.advance(time_);
    }
    const bool flown = flight_.advance(seconds);
    const bool dragged = hand_.drag(world_, camera(), mouse_x_, mouse_y_);
    moving_ = !paused_ || flown || dragged || edited_;
    edited_ = false;
}

bool Viewer::is_at_rest() const {
    return !moving_ && renderer_->samples() >= options_.samples;
}

/* While anything moves a picture is one sample without rays into the sky; at rest it is gathered from many with. */
void Viewer::trace(FrameTimes &times) {
    if (is_at_rest()) return;
    if (moving_ || quick_) renderer_->restart();
    quick_ = moving_;
    PassWants wants;
    wants.sky = !moving_;
    wants.corners = world_.smooth();
    wants.effort = overlays_.heat && renderer_->samples() == 0;
    Pass::Cost cost;
    const bool first = renderer_->samples() == 0;
    renderer_->add(world_.scene(), world_.looks(), camera(), renderer_->samples(), wants, cost);
    if (first) overlay_.survey(world_, renderer_->pass(), overlays_);
    times.primary = cost.primary, times.sun = cost.shadow;
    times.rays = cost.primary_rays + cost.shadow_rays;
}

void Viewer::draw() {
    canvas_.show(renderer_->picture(), crew_);
    overlay_.draw(canvas_, world_, overlays_, camera(), renderer_->picture(), hand_.held());
    if (overlays_.legend) overlay_.write_legend(canvas_, overlays_, letters_);
    write_text();
}

void Viewer::write_text() {
    int y = 4;
    const auto write = [&](const std::string &line) {
        letters_.write(canvas_, 8, y, line, Colour(1));
        y += letters_.height();
    };
    if (overlays_.text)
        for (const std::string &line : status(meter_.recent(), world_.grid())) write(line);
    if (overlays_.text && paused_) write("paused, " + std::to_string(renderer_->samples()) + " samples a pixel");
    if (overlays_.text && !overlays_.help) write("H: keys");
    if (overlays_.help)
        for (const char *line : keys) write(line);
}

void Viewer::write_shots() {
    for (const std::string &path : shots_) {
        if (std::filesystem::path(path).extension() == ".exr")
            write_exr(path, renderer_->picture());
        else
            canvas_.write(path);
        std::printf("wrote %s\n", path.c_str());
        std::fflush(stdout);
    }
    shots_.clear();
}

} // namespace viewer
