/* SPDX-License-Identifier: MIT */
/* viewer.h: the loop: events, the world's next moment, a picture of it, the window. */
#ifndef VIEWER_VIEWER_H
#define VIEWER_VIEWER_H

#include "clock.h"
#include "flight.h"
#include "hand.h"
#include "meter.h"
#include "overlay.h"
#include "script.h"
#include "world.h"

namespace viewer {

class Viewer {
  public:
    /** Throws std::runtime_error if a file can't be used or there is no screen. */
    explicit Viewer(const Options &options);

    /** Until the window is closed, or the last frame is done. */
    void run();

  private:
    void frame(uint32_t number);
    void handle_events();
    void handle(const SDL_Event &event);
    void handle_motion(double x, double y);
    void handle_button(const SDL_MouseButtonEvent &button);
    void handle_key(SDL_Keycode key);
    void change_grid(SDL_Keycode key);
    void change_things(SDL_Keycode key);
    void toggle(bool &overlay);
    void shoot_by_key(const char *extension);

    void resize();
    void step(double seconds);
    void trace(FrameTimes &times);
    void draw();
    void write_text();
    void write_shots();
    bool is_at_rest() const;
    demo::Camera camera() const { return flight_.camera(canvas_.width(), canvas_.height()); }

    const Options options_;
    const uint32_t workers_;
    Window window_;
    Letters letters_;
    Script script_;
    demo::Crew crew_;
    World world_;
    Flight flight_;
    Hand hand_;
    Overlays overlays_;
    Overlay overlay_;
    Meter meter_;
    Canvas canvas_;
    std::unique_ptr<demo::Renderer> renderer_;

    const demo::Stopwatch clock_;
    double last_ = 0; /* seconds of the clock at the last frame's begin */

    double time_; /* of the animation */
    bool paused_;
    rg_grid_kind kind_;
    uint32_t resolution_;
    double mouse_x_ = 0, mouse_y_ = 0; /* in the picture: the middle of a pixel */
    bool turning_ = false;             /* the right button is held */
    bool edited_ = true;               /* something changed since the last frame that must be seen */
    bool moving_ = true; /* the picture is of one quick sample, as all may be elsewhere in the next frame */
    bool quick_ = true;  /* what the renderer holds is such a picture */
    bool quit_ = false;
    std::vector<std::string> shots_; /* files that this frame is to be written to */
    uint32_t shots_by_key_ = 0;
};

} // namespace viewer

#endif
