// Work in a thread of its own: carries its reports to the caller's observer, the observer's wish to stop to
// the work, and ends what takes longer than it may.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/film/image_channels.h"
#include "core/render/render_driver.h"

namespace mote::session {

class RenderObserver;
struct Rendered;

class WatchedWork {
  public:
    /// `seconds`: limit in time from now on; nothing: none. `observer` must outlive this.
    WatchedWork(std::optional<double> seconds, RenderObserver& observer);

    /// Runs `work` and returns what it returns, or throws what it, or the observer, throws. Where the system
    /// grants no thread, `work` runs in the caller's and reports between its passes.
    Rendered run(const std::function<Rendered()>& work);

    // For the work:
    const std::atomic<bool>& stop() const { return stop_; }
    const std::atomic<bool>& time_is_over() const { return time_is_over_; }
    bool cancelled() const { return cancelled_; }  ///< by the caller
    /// True where the observer threw: what the work makes is discarded.
    const std::atomic<bool>& abandoned() const { return abandoned_; }
    const RenderObserver& observer() const { return observer_; }
    void begin_passes();  ///< the limit in time is now that of the last pass
    void end_passes();    ///< no limit in time any more
    void report(const core::RenderProgress& progress);
    void report(core::ImageChannels preview);
    void report(const std::string& warning);

  private:
    using Clock = std::chrono::steady_clock;
    /// Reports that wait for the observer.
    struct Reports {
        std::vector<std::string> warnings;
        std::optional<core::RenderProgress> progress;
        std::optional<core::ImageChannels> preview;
    };

    void watch();
    bool wait_for_end(Reports& reports);
    void deliver(const Reports& reports, bool ended);
    void deliver_here();
    void check_time();
    void cancel();

    const std::optional<double> seconds_;
    RenderObserver& observer_;
    const Clock::time_point start_ = Clock::now();
    std::atomic<bool> stop_{false}, time_is_over_{false}, cancelled_{false}, abandoned_{false};
    bool alone_ = false;  ///< no thread was granted
    std::mutex mutex_;
    std::condition_variable change_;
    // Guarded by the mutex:
    std::optional<Clock::time_point> deadline_;
    Reports reports_;
    bool done_ = false;
};

}  // namespace mote::session
