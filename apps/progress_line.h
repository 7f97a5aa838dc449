// Progress of a render, on stderr: one live line on a terminal, a plain line every few seconds elsewhere.
#pragma once

#include <chrono>
#include <string>

#include "core/render/render_driver.h"

namespace mote::apps {

/// "pass 12/64, 3.1 passes/s, 17 s left, noise 2.4 %"
std::string progress_text(const core::RenderProgress& progress);
/// "error 2.1 % (1.8 to 2.5 %)"
std::string error_text(const core::PictureError& error);
/// "17 s", "4:05 min", "2:30 h"
std::string duration_text(double seconds);

class ProgressLine {
  public:
    /// `header` is a line to print first: at once on a terminal, elsewhere with the first pass, so that a
    /// render that is refused leaves nothing but its error. Prints nothing when `quiet`.
    ProgressLine(std::string header, bool quiet);
    void update(const core::RenderProgress& progress);
    /// Shows a text of the caller's; `urgent`: shown on a terminal however recent the last one is.
    void update(const std::string& text, bool urgent);
    /// Ends the live line, so that other output starts on a line of its own.
    void end();

  private:
    void print_header();

    std::string header_;
    bool quiet_, terminal_, open_ = false;
    bool shown_ = false;
    std::chrono::steady_clock::time_point last_;
};

}  // namespace mote::apps
