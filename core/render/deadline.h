// A flag that sets itself when its time is over: for work that tests a CancelToken and may take so long.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace mote::core {

class Deadline {
  public:
    /// From now on. Throws std::system_error where the system grants no thread.
    explicit Deadline(double seconds)
        : end_(Clock::now() +
               std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds))),
          thread_([this](const std::stop_token& ended) { wait(ended); }) {}

    const std::atomic<bool>& is_over() const { return over_; }

  private:
    using Clock = std::chrono::steady_clock;

    void wait(const std::stop_token& ended) {
        std::unique_lock lock(mutex_);
        wake_.wait_until(lock, ended, end_, [] { return false; });
        over_ = !ended.stop_requested();
    }

    const Clock::time_point end_;
    std::atomic<bool> over_{false};
    std::mutex mutex_;
    std::condition_variable_any wake_;
    std::jthread thread_;  ///< last: it uses all others, and ends first
};

}  // namespace mote::core
