/* SPDX-License-Identifier: MIT */
/* crew.h: the host's own work on many pixels, shared out among threads: what is done between two traces. */
#ifndef DEMO_CREW_H
#define DEMO_CREW_H

#include <IlmThreadPool.h>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace demo {

class Crew {
  public:
    /** Records that one call of a body is given; the last may have fewer. */
    static constexpr size_t piece = 4096;

    using Body = std::function<void(size_t first, size_t end)>;

    /** `threads` that work together, the calling one among them; 0: one a processor. */
    explicit Crew(uint32_t threads);

    /** Calls body for pieces of [0, count), on any threads in any order; returns when all is done. It must not throw.
     */
    void run(size_t count, const Body &body);

  private:
    IlmThread::ThreadPool pool_; /* all but the calling thread */
};

} // namespace demo

#endif
