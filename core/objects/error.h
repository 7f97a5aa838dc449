// Errors that are the input's fault. They carry the file and, where there is one, the line.
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace mote::core {

struct SourceLocation {
    std::string file;  ///< "" where there is none
    int line = 0;      ///< 1-based; 0 when there is none
};

/// The input is at fault: what() is one line "file:line: message". Leads to exit code 1.
class InputError : public std::runtime_error {
  public:
    /// `message` is one sentence that says what is wrong, and what would be right.
    explicit InputError(const std::string& message, const SourceLocation& where = {});
    const SourceLocation& where() const { return where_; }  ///< the place in the input

  private:
    SourceLocation where_;
};

/// The candidate with the smallest edit distance to `name` (case and underscores ignored), or "" when none is
/// near.
std::string nearest_name(std::string_view name, std::span<const std::string> candidates);

/// " (did you mean 'x'?)" or, when nothing is near, " (known: a, b, c)". Empty when there are no candidates.
std::string suggestion(std::string_view name, std::span<const std::string> candidates);

/// Text from an untrusted file made safe for one line of terminal output: control bytes replaced, length
/// limited.
std::string printable(std::string_view text, std::size_t max_length = 120);

}  // namespace mote::core
