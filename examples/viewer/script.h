/* SPDX-License-Identifier: MIT */
/* script.h: keys and the mouse without a hand: SDL's events, at given frames, from a file. */
#ifndef VIEWER_SCRIPT_H
#define VIEWER_SCRIPT_H

#include <SDL_events.h>
#include <cstdint>
#include <string>
#include <vector>

namespace viewer {

class Script {
  public:
    Script() = default;

    /**
     * Reads lines "FRAME key NAME", "FRAME press X Y", "FRAME move X Y", "FRAME release X Y" (the left button),
     * "FRAME shot FILE" and "FRAME quit"; FRAME counts from 0. Empty lines and those that begin with # are passed
     * over. Throws std::runtime_error that names the line.
     */
    explicit Script(const std::string &path);

    /** Puts the events of a frame into SDL's queue; adds the files that the frame is to be written to. */
    void play(uint32_t frame, std::vector<std::string> &shots) const;

  private:
    struct Step {
        uint32_t frame;
        std::vector<SDL_Event> events;
        std::string shot;
    };
    static bool read_step(const std::string &text, Step &step);

    std::vector<Step> steps_;
};

} // namespace viewer

#endif
