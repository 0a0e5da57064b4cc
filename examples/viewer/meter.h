/* SPDX-License-Identifier: MIT */
/* meter.h: what frames take, on the screen and in the end. */
#ifndef VIEWER_METER_H
#define VIEWER_METER_H

#include <cstdint>
#include <deque>
#include <string>

namespace viewer {

/** Seconds of one frame, and what they were spent on. */
struct FrameTimes {
    double all = 0;
    double processor = 0;        /* of all threads together: what is left when others use the machine, too */
    double update = 0;           /* raygrid's changes of the scene */
    double primary = 0, sun = 0; /* raygrid's traces */
    uint64_t rays = 0;
};

class Meter {
  public:
    void add(const FrameTimes &times);

    /** Means of the last frames. */
    FrameTimes recent() const;

    /** Frames a second over the frames but the first, medians of the parts, load of the machine. */
    std::string report(uint32_t width, uint32_t height, uint32_t workers) const;

  private:
    std::deque<FrameTimes> frames_; /* the last ones alone: a session may be long */
    bool begun_ = false;
};

} // namespace viewer

#endif
