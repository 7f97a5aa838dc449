#include "session/watched_work.h"

#include <algorithm>
#include <exception>
#include <thread>

#include "core/render/stop_clock.h"
#include "session/render.h"

namespace mote::session {

namespace {

constexpr auto between_looks = std::chrono::milliseconds(50);

std::chrono::steady_clock::duration duration(double seconds) {
    return std::chrono::duration_cast<std::chrono::steady_clock::duration>(
        std::chrono::duration<double>(std::clamp(seconds, 0.0, 1e8)));
}

}  // namespace

WatchedWork::WatchedWork(const RenderSettings& settings) : settings_(settings) {
    if (settings.stop.seconds) deadline_ = start_ + duration(*settings.stop.seconds + 2.0);  // of building
}

Rendered WatchedWork::run(const std::function<Rendered()>& work) {
    std::optional<Rendered> result;
    std::exception_ptr of_work, of_callback;
    std::thread thread([&] {
        try {
            result = work();
        } catch (...) {
            of_work = std::current_exception();
        }
        const std::lock_guard lock(mutex_);
        done_ = true;
        news_.notify_all();
    });
    try {
        watch();
    } catch (...) {
        of_callback = std::current_exception();
        cancel();
    }
    thread.join();
    if (of_callback) std::rethrow_exception(of_callback);
    if (of_work) std::rethrow_exception(of_work);
    return std::move(*result);
}

/// Until the work is done; the callbacks are called without the lock.
void WatchedWork::watch() {
    for (bool done = false; !done;) {
        std::optional<core::RenderProgress> progress;
        std::optional<core::ImageChannels> picture;
        {
            std::unique_lock lock(mutex_);
            news_.wait_for(lock, between_looks, [&] { return done_; });
            look_at_clock();
            done = done_;
            progress.swap(progress_), picture.swap(picture_);
        }
        if (progress) settings_.progress(*progress);
        if (picture && !done) settings_.preview(*picture);
        if (!done && !cancelled_ && settings_.cancelled && settings_.cancelled()) cancel();
    }
}

void WatchedWork::look_at_clock() {
    if (!deadline_ || Clock::now() < *deadline_) return;
    deadline_.reset();
    time_is_over_ = true, stop_ = true;
}

void WatchedWork::cancel() {
    const std::lock_guard lock(mutex_);  // forget_time() must see both or none
    cancelled_ = true, stop_ = true;
}

void WatchedWork::begin_passes() {
    if (!settings_.stop.seconds) return;
    const std::lock_guard lock(mutex_);
    // A pass may end a second late (stop_clock.h); what takes longer is cut off.
    deadline_ = std::max(Clock::now() + duration(0.5),
                         start_ + duration(*settings_.stop.seconds + core::most_seconds_late));
}

void WatchedWork::forget_time() {
    const std::lock_guard lock(mutex_);
    deadline_.reset();
    if (!cancelled_) stop_ = false;
}

void WatchedWork::tell(const core::RenderProgress& progress) {
    const std::lock_guard lock(mutex_);
    progress_ = progress;
}

void WatchedWork::show(core::ImageChannels picture) {
    const std::lock_guard lock(mutex_);
    picture_ = std::move(picture);
}

}  // namespace mote::session
