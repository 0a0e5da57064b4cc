/* SPDX-License-Identifier: MIT */
#include "window.h"

#include <stdexcept>

namespace viewer {

namespace {

[[noreturn]] void fail(const std::string &what) {
    throw std::runtime_error(what + ": " + SDL_GetError());
}

struct SurfaceEnd {
    void operator()(SDL_Surface *surface) const { SDL_FreeSurface(surface); }
};
using SurfacePointer = std::unique_ptr<SDL_Surface, SurfaceEnd>;

/* The pixels as SDL knows them. */
SurfacePointer surface_of(const Canvas &canvas) {
    auto *pixels = const_cast<uint32_t *>(canvas.pixels());
    SurfacePointer surface(SDL_CreateRGBSurfaceWithFormatFrom(pixels, int(canvas.width()), int(canvas.height()), 32,
                                                              int(4 * canvas.width()), SDL_PIXELFORMAT_RGB888));
    if (!surface) fail("no surface for the pixels");
    return surface;
}

Uint8 byte(float x) {
    return Uint8(255 * x + 0.5f);
}

} // namespace

/* ------------------------------------------------------------------------------------------------ window */

Window::Window(const char *title, uint32_t width, uint32_t height, bool visible) {
    if (!visible) SDL_SetHint(SDL_HINT_VIDEODRIVER, "dummy");
    SDL_SetHint(SDL_HINT_FRAMEBUFFER_ACCELERATION, "0"); /* pixels are made here: no need for OpenGL */
    if (SDL_Init(SDL_INIT_VIDEO) != 0) fail("no screen");
    window_ = SDL_CreateWindow(title, SDL_WINDOWPOS_UNDEFINED, SDL_WINDOWPOS_UNDEFINED, int(width), int(height),
                               SDL_WINDOW_RESIZABLE);
    if (window_) return;
    const std::string why = SDL_GetError();
    SDL_Quit();
    throw std::runtime_error("no window: " + why);
}

Window::~Window() {
    SDL_DestroyWindow(window_);
    SDL_Quit();
}

uint32_t Window::width() const {
    int width = 0;
    SDL_GetWindowSize(window_, &width, nullptr);
    return uint32_t(width);
}

uint32_t Window::height() const {
    int height = 0;
    SDL_GetWindowSize(window_, nullptr, &height);
    return uint32_t(height);
}

void Window::show(const Canvas &canvas) {
    SDL_Surface *screen = SDL_GetWindowSurface(window_);
    if (!screen || SDL_BlitSurface(surface_of(canvas).get(), nullptr, screen, nullptr) != 0 ||
        SDL_UpdateWindowSurface(window_) != 0)
        fail("can't draw in the window");
}

/* ----------------------------------------------------------------------------------------------- letters */

Letters::Letters(const std::string &font, int size) {
    if (TTF_Init() != 0) fail("no text");
    font_ = TTF_OpenFont(font.c_str(), size);
    if (font_) return;
    const std::string why = SDL_GetError();
    TTF_Quit();
    throw std::runtime_error("can't open the font '" + font + "': " + why +
                             " (Debian has it in fonts-dejavu-core; --font names another)");
}

Letters::~Letters() {
    TTF_CloseFont(font_);
    TTF_Quit();
}

int Letters::width(const std::string &line) const {
    int width = 0;
    TTF_SizeUTF8(font_, line.c_str(), &width, nullptr);
    return width;
}

void Letters::write(Canvas &canvas, int x, int y, const std::string &line, const Colour &colour) const {
    const SDL_Color ink = {byte(colour.x), byte(colour.y), byte(colour.z), 255};
    const SurfacePointer text(TTF_RenderUTF8_Blended(font_, line.c_str(), ink));
    if (!text) fail("can't write '" + line + "'");
    constexpr int margin = 3;
    const int right = std::min(x + text->w + margin, int(canvas.width()));
    const int bottom = std::min(y + text->h, int(canvas.height()));
    for (int row = std::max(y, 0); row < bottom; ++row)
        for (int column = std::max(x - margin, 0); column < right; ++column)
            canvas.cover(size_t(row) * canvas.width() + size_t(column), Colour(0), 0.55f);
    SDL_Rect place = {x, y, text->w, text->h};
    SDL_BlitSurface(text.get(), nullptr, surface_of(canvas).get(), &place);
}

} // namespace viewer
