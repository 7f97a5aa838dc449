// A value that is found when it is first needed.
#pragma once

#include <mutex>

namespace mote::core {

/// A property that costs time and memory to find, and that few scenes need. Any thread may call first; the
/// others wait for it.
template <typename T>
class FoundOnce {
  public:
    /// The value of the first call's `find()`, which must not run parallel tasks: a thread that waits in one
    /// of them could be given one that needs the same value. Where it throws, the next call finds it.
    template <typename Find>
    const T& get(const Find& find) const {
        std::call_once(once_, [&] { value_ = find(); });
        return value_;
    }

  private:
    mutable std::once_flag once_;
    mutable T value_{};
};

}  // namespace mote::core
