// Work in a thread of its own, watched by the one that asked for it: carries news to the caller's callbacks,
// the wish to stop from them, and ends what takes longer than it may.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>

#include "core/film/image_channels.h"
#include "core/render/render_driver.h"

namespace mote::session {

struct RenderSettings;
struct Rendered;

class WatchedWork {
  public:
    explicit WatchedWork(const RenderSettings& settings);

    /// Runs `work` and returns what it returns, or throws what it, or a callback, throws.
    Rendered run(const std::function<Rendered()>& work);

    // For the work:
    const std::atomic<bool>& stop() const { return stop_; }
    const std::atomic<bool>& time_is_over() const { return time_is_over_; }
    bool cancelled() const { return cancelled_; }  ///< by the caller
    void begin_passes();                           ///< the limit in time is now that of the last pass
    void forget_time();                            ///< passes are over
    void tell(const core::RenderProgress& progress);
    void show(core::ImageChannels picture);

  private:
    using Clock = std::chrono::steady_clock;
    void watch();
    void look_at_clock();
    void cancel();

    const RenderSettings& settings_;
    const Clock::time_point start_ = Clock::now();
    std::atomic<bool> stop_{false}, time_is_over_{false}, cancelled_{false};
    std::mutex mutex_;
    std::condition_variable news_;
    // Guarded by the mutex:
    std::optional<Clock::time_point> deadline_;
    std::optional<core::RenderProgress> progress_;
    std::optional<core::ImageChannels> picture_;
    bool done_ = false;
};

}  // namespace mote::session
