#include "session/watched_work.h"

#include <algorithm>
#include <exception>
#include <system_error>
#include <thread>
#include <utility>

#include "core/render/stop_clock.h"
#include "session/render.h"

namespace mote::session {

namespace {

constexpr auto delivery_interval = std::chrono::milliseconds(50);
/// Time that loading and building may take beyond the limit [s].
constexpr double max_seconds_late_of_building = 2.0;

std::chrono::steady_clock::duration duration(double seconds) {
    return std::chrono::duration_cast<std::chrono::steady_clock::duration>(
        std::chrono::duration<double>(std::clamp(seconds, 0.0, 1e8)));
}

}  // namespace

WatchedWork::WatchedWork(std::optional<double> seconds, RenderObserver& observer)
    : seconds_(seconds), observer_(observer) {
    if (seconds) deadline_ = start_ + duration(*seconds + max_seconds_late_of_building);
}

Rendered WatchedWork::run(const std::function<Rendered()>& work) {
    std::optional<Rendered> result;
    std::exception_ptr of_work, of_observer;
    const auto run_it = [&] {
        try {
            result = work();
        } catch (...) {
            of_work = std::current_exception();
        }
        const std::lock_guard lock(mutex_);
        done_ = true;
        change_.notify_all();
    };
    std::thread thread;
    try {
        thread = std::thread(run_it);
    } catch (const std::system_error&) {
        alone_ = true;
        run_it();
    }
    try {
        watch();
    } catch (...) {
        of_observer = std::current_exception();
        abandoned_ = true;
        cancel();
    }
    if (thread.joinable()) thread.join();
    if (of_observer) std::rethrow_exception(of_observer);
    if (of_work) std::rethrow_exception(of_work);
    return std::move(*result);
}

/// Until the work is done; the observer is called without the lock.
void WatchedWork::watch() {
    for (bool ended = false; !ended;) {
        Reports reports;
        ended = wait_for_end(reports);
        deliver(reports, ended);
    }
}

bool WatchedWork::wait_for_end(Reports& reports) {
    std::unique_lock lock(mutex_);
    change_.wait_for(lock, delivery_interval, [&] { return done_; });
    check_time();
    std::swap(reports, reports_);
    return done_;
}

void WatchedWork::deliver(const Reports& reports, bool ended) {
    for (const std::string& text : reports.warnings) observer_.warning(text);
    if (reports.progress) observer_.progress(*reports.progress);
    if (reports.preview && !ended) observer_.preview(*reports.preview);
    if (!ended && !cancelled_ && observer_.cancelled()) cancel();
}

void WatchedWork::deliver_here() {
    if (!alone_) return;
    check_time();
    deliver(std::exchange(reports_, {}), false);
}

void WatchedWork::check_time() {
    if (!deadline_ || Clock::now() < *deadline_) return;
    deadline_.reset();
    time_is_over_ = true, stop_ = true;
}

void WatchedWork::cancel() {
    const std::lock_guard lock(mutex_);  // end_passes() must see both or none
    cancelled_ = true, stop_ = true;
}

void WatchedWork::begin_passes() {
    observer_.building_is_over();
    if (!seconds_) return;
    const std::lock_guard lock(mutex_);
    // A pass may end a second late (stop_clock.h); what takes longer is cut off.
    deadline_ = std::max(Clock::now() + duration(0.5), start_ + duration(*seconds_ + core::max_seconds_late));
}

void WatchedWork::end_passes() {
    const std::lock_guard lock(mutex_);
    deadline_.reset();
    if (!cancelled_) stop_ = false;
}

void WatchedWork::report(const core::RenderProgress& progress) {
    {
        const std::lock_guard lock(mutex_);
        reports_.progress = progress;
    }
    deliver_here();
}

void WatchedWork::report(core::ImageChannels preview) {
    const std::lock_guard lock(mutex_);
    reports_.preview = std::move(preview);
}

void WatchedWork::report(const std::string& warning) {
    const std::lock_guard lock(mutex_);
    reports_.warnings.push_back(warning);
}

}  // namespace mote::session
