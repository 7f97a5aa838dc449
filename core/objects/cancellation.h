// The wish to stop, passed down to whatever takes long: a flag that a signal or a clock sets.
//
// Loops that can end early return; what lies deeper throws Cancelled, which unwinds through parallel loops
// and is caught where a pass is run. What was half done is discarded. A test costs one load.
#pragma once

#include <atomic>

namespace mote::core {

/// Thrown where work is cancelled. No std::exception: it is no error.
struct Cancelled {};

/// Reference to a flag that cancels work.
class CancelToken {
  public:
    CancelToken() = default;  ///< never
    /// The flag must outlive the token.
    CancelToken(const std::atomic<bool>& flag) : flag_(&flag) {}  // NOLINT: a flag is a token

    /// True if the flag has been set.
    bool requested() const { return flag_ && flag_->load(std::memory_order_relaxed); }
    /// Throws Cancelled where it has.
    void check() const {
        if (requested()) throw Cancelled();
    }

  private:
    const std::atomic<bool>* flag_ = nullptr;
};

}  // namespace mote::core
