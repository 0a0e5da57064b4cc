/* SPDX-License-Identifier: MIT */
/* clock.h: seconds on the wall, by a clock that never jumps. */
#ifndef DEMO_CLOCK_H
#define DEMO_CLOCK_H

#include <chrono>

namespace demo {

class Stopwatch {
  public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

} // namespace demo

#endif
