/* SPDX-License-Identifier: MIT */
/* report.h: what the demo tells while it runs: a table on stdout, progress on stderr, a summary at the end. */
#ifndef DEMO_REPORT_H
#define DEMO_REPORT_H

#include "render.h"
#include "verify.h"
#include "world.h"

namespace demo {

/** What is known of one frame. */
struct Frame {
    World::Update update;
    Pass::Cost cost;
    Errors errors;
    uint64_t objects, rebuilds, tiles;
};

class Report {
  public:
    explicit Report(const Options &options);

    /** A line on stderr about what is left out of a file. */
    void note(const std::string &text);

    /** A row of the table, and progress. */
    void add(const Frame &frame);

    /** Medians and totals. */
    void finish(const std::string &out);

    size_t wrong() const { return wrong_; }

  private:
    void clear_bar();
    void draw_bar();

    Options options_;
    bool terminal_;
    std::vector<Frame> frames_;
    size_t wrong_ = 0;
};

} // namespace demo

#endif
