/* SPDX-License-Identifier: MIT */
/* controls.cpp: what the viewer does with keys and the mouse. */
#include "viewer.h"

#include <algorithm>
#include <cstdio>

namespace viewer {

using namespace demo;
using Imath::V3d;

namespace {

constexpr double arm = 4; /* how far away things are put where nothing is seen */
constexpr uint32_t coarsest = 2, finest = 512;

V3d vector_of(const double v[3]) {
    return {v[0], v[1], v[2]};
}

/* Where a new thing is put: on what is seen, or in the air. */
V3d free_place(const rg_hit &hit, const Camera &camera, double x, double y) {
    if (hit.object == RG_NO_OBJECT) return camera.place(x, y, arm);
    V3d up(hit.normal[0], hit.normal[1], hit.normal[2]);
    const V3d spot = vector_of(hit.position);
    if (up.dot(spot - camera.eye) > 0) up = -up;
    return spot + up * World::handful;
}

} // namespace

void Viewer::handle_events() {
    SDL_Event event;
    while (SDL_PollEvent(&event)) handle(event);
}

void Viewer::handle(const SDL_Event &event) {
    switch (event.type) {
    case SDL_QUIT:
        quit_ = true;
        break;
    case SDL_KEYDOWN:
        if (Flight::flies_by(event.key.keysym.sym))
            flight_.press(event.key.keysym.sym);
        else if (!event.key.repeat)
            handle_key(event.key.keysym.sym);
        break;
    case SDL_KEYUP:
        flight_.release(event.key.keysym.sym);
        break;
    case SDL_MOUSEMOTION:
        handle_motion(event.motion.x + 0.5, event.motion.y + 0.5);
        break;
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEBUTTONUP:
        handle_button(event.button);
        break;
    case SDL_MOUSEWHEEL:
        hand_.push(event.wheel.y);
        break;
    case SDL_WINDOWEVENT:
        if (event.window.event == SDL_WINDOWEVENT_FOCUS_LOST) flight_.release_all();
        break;
    default:
        break;
    }
}

void Viewer::handle_motion(double x, double y) {
    if (turning_) flight_.turn(x - mouse_x_, y - mouse_y_);
    mouse_x_ = x, mouse_y_ = y;
}

void Viewer::handle_button(const SDL_MouseButtonEvent &button) {
    const bool down = button.type == SDL_MOUSEBUTTONDOWN;
    if (button.button == SDL_BUTTON_RIGHT) turning_ = down;
    if (button.button != SDL_BUTTON_LEFT) return;
    mouse_x_ = button.x + 0.5, mouse_y_ = button.y + 0.5;
    hand_.drag(world_, camera(), mouse_x_, mouse_y_); /* there may have been no frame since the mouse came here */
    hand_.let_go();
    if (down) hand_.grab(world_, camera(), mouse_x_, mouse_y_);
    edited_ = true;
}

void Viewer::handle_key(SDL_Keycode key) {
    switch (key) {
    case SDLK_ESCAPE:
        quit_ = true;
        break;
    case SDLK_SPACE:
        paused_ = !paused_;
        break;
    case SDLK_HOME:
        flight_.go_home();
        break;
    case SDLK_1:
        toggle(overlays_.boxes);
        break;
    case SDLK_2:
        toggle(overlays_.cells);
        break;
    case SDLK_3:
        toggle(overlays_.levels);
        break;
    case SDLK_4:
        toggle(overlays_.heat);
        break;
    case SDLK_t:
        toggle(overlays_.text);
        overlays_.legend = overlays_.text;
        break;
    case SDLK_h:
        toggle(overlays_.help);
        break;
    case SDLK_p:
        shoot_by_key(".png");
        break;
    case SDLK_o:
        shoot_by_key(".exr");
        break;
    default:
        change_grid(key);
        change_things(key);
        break;
    }
}

/* What an overlay shows is looked up at a picture's first sample. */
void Viewer::toggle(bool &overlay) {
    overlay = !overlay;
    edited_ = true;
}

void Viewer::shoot_by_key(const char *extension) {
    char name[48];
    std::snprintf(name, sizeof name, "raygrid-%04u%s", unsigned(shots_by_key_++), extension);
    shots_.push_back(name);
}

/* The loose kind has no resolution: what is chosen waits for a kind that has one. */
void Viewer::change_grid(SDL_Keycode key) {
    switch (key) {
    case SDLK_g:
        kind_ = kind_ == RG_GRID_LOOSE          ? RG_GRID_HIERARCHICAL
                : kind_ == RG_GRID_HIERARCHICAL ? RG_GRID_UNIFORM
                                                : RG_GRID_LOOSE;
        break;
    case SDLK_LEFTBRACKET:
    case SDLK_RIGHTBRACKET: {
        const rg_grid_report grid = world_.grid();
        const uint32_t now = *std::max_element(grid.resolution, grid.resolution + 3);
        const uint32_t from = now > 0 ? now : resolution_ > 0 ? resolution_ : 64;
        resolution_ = std::clamp(key == SDLK_LEFTBRACKET ? from / 2 : from * 2, coarsest, finest);
        break;
    }
    case SDLK_r:
        break;
    default:
        return;
    }
    world_.configure(kind_, resolution_);
    edited_ = true;
}

void Viewer::change_things(SDL_Keycode key) {
    if (key != SDLK_i && key != SDLK_b && key != SDLK_x && key != SDLK_DELETE) return;
    const rg_hit hit = look_at(world_.scene(), camera(), mouse_x_, mouse_y_);
    if (key == SDLK_i || key == SDLK_b) {
        const V3d place = free_place(hit, camera(), mouse_x_, mouse_y_);
        key == SDLK_i ? world_.insert_ball(place) : world_.insert_box(place);
    } else if (hand_.held() != RG_NO_OBJECT) {
        world_.remove(hand_.held());
        hand_.let_go();
    } else if (hit.object != RG_NO_OBJECT && world_.take(hit.object)) {
        world_.remove(hit.object);
    }
    edited_ = true;
}

} // namespace viewer
