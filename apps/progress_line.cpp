// Progress on stderr.
#include "apps/progress_line.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace mote::apps {

namespace {

constexpr std::chrono::milliseconds live_interval(100);
constexpr std::chrono::seconds plain_interval(5);

}  // namespace

std::string duration_text(double seconds) {
    const auto s = std::int64_t(std::ceil(std::fmin(seconds, 1e9)));
    if (s < 60) return fmt::format("{} s", s);
    if (s < 3600) return fmt::format("{}:{:02} min", s / 60, s % 60);
    return fmt::format("{}:{:02} h", s / 3600, s / 60 % 60);
}

std::string error_text(const core::PictureError& error) {
    return fmt::format("error {:.2g} % ({:.2g} to {:.2g} %)", 100.0 * error.error, 100.0 * error.low,
                       100.0 * error.high);
}

std::string progress_text(const core::RenderProgress& p) {
    std::string text = fmt::format("pass {}", p.passes);
    if (p.passes_wanted) text += fmt::format("/{}", *p.passes_wanted);
    if (p.seconds > 0.0) text += fmt::format(", {:.3g} passes/s", p.passes_of_this_run / p.seconds);
    if (p.seconds_left >= 0.0) text += ", " + duration_text(p.seconds_left) + " left";
    if (std::isfinite(p.error.high)) text += ", " + error_text(p.error);
    if (std::isfinite(p.noise)) text += fmt::format(", noise {:.2g} %", 100.0 * p.noise);
    return text;
}

ProgressLine::ProgressLine(std::string header, bool quiet)
    : header_(std::move(header)),
      quiet_(quiet),
      terminal_(::isatty(STDERR_FILENO) == 1),
      last_(std::chrono::steady_clock::now()) {
    if (terminal_) print_header();
}

void ProgressLine::print_header() {
    if (!quiet_ && !header_.empty()) std::fputs(fmt::format("{}\n", header_).c_str(), stderr);
    header_.clear();
}

void ProgressLine::update(const core::RenderProgress& progress) {
    const bool last_pass = progress.passes_wanted && progress.passes >= *progress.passes_wanted;
    update(progress_text(progress), last_pass);
}

void ProgressLine::update(const std::string& text, bool urgent) {
    if (quiet_) return;
    print_header();
    const auto now = std::chrono::steady_clock::now();
    const auto interval = terminal_ ? std::chrono::duration_cast<std::chrono::milliseconds>(live_interval)
                                    : std::chrono::duration_cast<std::chrono::milliseconds>(plain_interval);
    if (now - last_ < interval && shown_ && !urgent) return;
    if (now - last_ < interval && !terminal_) return;  // a render of a second needs no line in a log
    last_ = now, shown_ = true;
    if (terminal_) {
        std::fputs(("\r" + text + "\x1b[K").c_str(), stderr);
        std::fflush(stderr);
        open_ = true;
    } else {
        std::fputs((text + "\n").c_str(), stderr);
    }
}

void ProgressLine::end() {
    if (open_) std::fputs("\n", stderr);
    open_ = false;
}

}  // namespace mote::apps
