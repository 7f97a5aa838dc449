// Ctrl-C and SIGTERM while a render runs: a flag that the render looks at.
#pragma once

#include <atomic>

namespace mote::apps {

/// From construction to destruction the first signal sets flag() instead of ending the program. More signals
/// within five seconds change nothing (shells and wrappers send several); later ones end it at once.
class Interruption {
  public:
    Interruption();
    ~Interruption();
    Interruption(const Interruption&) = delete;
    Interruption& operator=(const Interruption&) = delete;

    const std::atomic<bool>& flag() const;
    int signal_number() const;  ///< 0 while there was none
};

}  // namespace mote::apps
