// Words and numbers out of one piece of text, with no allocation and no locale.
#pragma once

#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

namespace mote::core {

class TextScanner {
  public:
    explicit TextScanner(std::string_view text) : rest_(text) {}

    /// The next run of characters other than white space; empty at the end.
    std::string_view word() {
        std::size_t begin = 0;
        while (begin < rest_.size() && is_space(rest_[begin])) ++begin;
        std::size_t end = begin;
        while (end < rest_.size() && !is_space(rest_[end])) ++end;
        const std::string_view found = rest_.substr(begin, end - begin);
        rest_.remove_prefix(end);
        return found;
    }
    std::optional<double> number() { return parse_number(word()); }
    std::size_t remaining() const { return rest_.size(); }

    /// The whole word as a number; a magnitude out of range becomes infinity or zero.
    static std::optional<double> parse_number(std::string_view text) {
        if (!text.empty() && text.front() == '+') text.remove_prefix(1);
        double value = 0.0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error == std::errc::result_out_of_range) return std::numeric_limits<double>::infinity();
        if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
        return value;
    }

  private:
    static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
    std::string_view rest_;
};

}  // namespace mote::core
