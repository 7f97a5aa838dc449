// Memory that this process may still allocate, so that what does not fit is refused before it is begun and
// not ended by the system.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

namespace mote::core {

/// The smallest of the physical memory that is available, what the control groups (v1 and v2) of this process
/// leave, and what its limit on the address space leaves [B]; infinity where none is known. `root`: folder
/// that holds /proc and /sys, for tests.
double available_memory(const std::string& root = "");

/// A limit that large allocations are compared with beforehand. It holds no state of the process: the
/// system's is read anew for every question, so memory that others have taken meanwhile counts.
class MemoryBudget {
  public:
    MemoryBudget() = default;  ///< available_memory(), but for a twentieth that all small things share
    explicit MemoryBudget(double bytes) : fixed_(bytes) {}  ///< this many, whatever the system has [B]

    /// Bytes that may be allocated now; never negative.
    double available() const;
    /// The budget but for bytes that are to be allocated later.
    MemoryBudget without(double bytes) const;
    /// The smaller of available() and a limit of a method's own [B].
    std::size_t at_most(std::size_t limit) const;
    /// Throws OutOfMemory where `bytes` exceed available(), with the purpose, both numbers, and the text of
    /// `fits`, a function of available() that says what would fit.
    void require(double bytes, const std::string& purpose,
                 const std::function<std::string(double)>& fits = {}) const;

  private:
    std::optional<double> fixed_;
    double later_ = 0.0;
};

}  // namespace mote::core
