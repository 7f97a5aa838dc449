// Out of memory, with what it was for.
#pragma once

#include <new>
#include <string>

namespace mote::core {

/// what() says what was allocated for, and how much that takes where it is known.
class OutOfMemory : public std::bad_alloc {
  public:
    explicit OutOfMemory(std::string purpose) : purpose_(std::move(purpose)) {}
    const char* what() const noexcept override { return purpose_.c_str(); }

  private:
    std::string purpose_;
};

/// Runs `work`; where memory runs out says that it was for `purpose`, unless the error names a purpose
/// already.
template <typename Work>
auto with_memory_for(const std::string& purpose, Work&& work) -> decltype(work()) {
    try {
        return work();
    } catch (const OutOfMemory&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw OutOfMemory(purpose);
    }
}

/// " (1.2 GB)"
inline std::string memory_text(double bytes) {
    const bool giga = bytes >= 1e9;
    std::string text = std::to_string(giga ? bytes * 1e-9 : bytes * 1e-6);
    return " (" + text.substr(0, text.find('.') + 2) + (giga ? " GB)" : " MB)");
}

}  // namespace mote::core
