// Libraries that print: what they say is caught, and can stand in our own message instead.
#pragma once

#include <mutex>
#include <string>

namespace mote::core {

/// While this lives, the process's stderr goes to memory; one at a time. libpng prints its messages itself,
/// and OpenImageIO leaves it no other way.
class QuietStderr {
  public:
    QuietStderr();
    ~QuietStderr();
    QuietStderr(const QuietStderr&) = delete;
    QuietStderr& operator=(const QuietStderr&) = delete;
    /// Text printed so far: its last line, at most 200 characters.
    std::string last_line() const;

  private:
    std::unique_lock<std::mutex> lock_;
    int memory_ = -1, kept_ = -1;
};

}  // namespace mote::core
