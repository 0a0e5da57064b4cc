/* SPDX-License-Identifier: MIT */
/* window.h: the window, and text on its pixels: SDL and its fonts. */
#ifndef VIEWER_WINDOW_H
#define VIEWER_WINDOW_H

#include "canvas.h"

#include <SDL.h>
#include <SDL_ttf.h>
#include <memory>

namespace viewer {

class Window {
  public:
    /** Invisible: SDL's driver that has no screen. Throws std::runtime_error. */
    Window(const char *title, uint32_t width, uint32_t height, bool visible);
    ~Window();
    Window(const Window &) = delete;
    Window &operator=(const Window &) = delete;

    /** Pixels of the window as it is now. */
    uint32_t width() const;
    uint32_t height() const;

    void show(const Canvas &canvas);

  private:
    SDL_Window *window_ = nullptr;
};

class Letters {
  public:
    /** Throws std::runtime_error. */
    Letters(const std::string &font, int size);
    ~Letters();
    Letters(const Letters &) = delete;
    Letters &operator=(const Letters &) = delete;

    /** Writes a line from x, y on, its upper left, over darkened pixels. */
    void write(Canvas &canvas, int x, int y, const std::string &line, const Colour &colour) const;

    int height() const { return TTF_FontLineSkip(font_); }
    int width(const std::string &line) const;

  private:
    TTF_Font *font_ = nullptr;
};

} // namespace viewer

#endif
