// Signals that end a render early, and the clock that does: a flag that the render checks.
#pragma once

#include <atomic>
#include <optional>

namespace mote::apps {

/// From construction to destruction the first Ctrl-C, SIGTERM or SIGHUP sets flag() instead of ending the
/// program, and so does the end of the time. The second signal ends it at once (shells and wrappers send
/// several within a moment: those count as one). With SIGHUP the terminal is gone: writing to it must not end
/// the program, either.
class Interruption {
  public:
    Interruption();
    ~Interruption();
    Interruption(const Interruption&) = delete;
    Interruption& operator=(const Interruption&) = delete;

    /// While there is nothing to be lost (`phase`: "loading the scene"), a signal or the end of the time ends
    /// the program at once, with one line, which ends in `why`. Both must be literals; null: from now on
    /// there is.
    void end_at_once_while(const char* phase, const char* why = "no pixel was rendered yet");
    /// From now on files are written, perhaps into a folder that hangs: the first signal waits for them and
    /// prints a line that says so.
    void writing_begins();
    /// The end of the time, from now [s]; nothing: no more.
    void set_alarm(std::optional<double> seconds);

    const std::atomic<bool>& flag() const;
    const std::atomic<bool>& time_is_over() const;
    int signal_number() const;  ///< 0 while there was none
};

/// A limit on the size of files (ulimit -f) is to be an error of the write, not the end of the program.
void ignore_file_size_signal();

}  // namespace mote::apps
