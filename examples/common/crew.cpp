/* SPDX-License-Identifier: MIT */
#include "crew.h"

#include <algorithm>
#include <atomic>
#include <thread>

namespace demo {

namespace {

class Work : public IlmThread::Task {
  public:
    Work(IlmThread::TaskGroup *group, const std::function<void()> &work) : Task(group), work_(work) {}
    void execute() override { work_(); }

  private:
    const std::function<void()> &work_;
};

uint32_t threads_wanted(uint32_t threads) {
    return threads > 0 ? threads : std::max(1u, std::thread::hardware_concurrency());
}

} // namespace

Crew::Crew(uint32_t threads) : pool_(threads_wanted(threads) - 1) {}

void Crew::run(size_t count, const Body &body) {
    std::atomic<size_t> next(0);
    const std::function<void()> work = [&] {
        for (size_t first; (first = next.fetch_add(piece)) < count;) body(first, std::min(first + piece, count));
    };
    IlmThread::TaskGroup group; /* waits for its tasks when it goes out of scope: declared after what they use */
    for (int i = 0; i < pool_.numThreads(); ++i) pool_.addTask(new Work(&group, work));
    work();
}

} // namespace demo
