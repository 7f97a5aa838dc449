// The parser reads through an iterator that counts lines, and reports every key as soon as it is read.
#include "trade/json_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <vector>

namespace mote::trade {

namespace {

using nlohmann::json;

class CountingIterator {
  public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    CountingIterator(const char* at, int* line) : at_(at), line_(line) {}
    reference operator*() const { return *at_; }
    CountingIterator& operator++() {
        *line_ += *at_++ == '\n';
        return *this;
    }
    CountingIterator operator++(int) {
        CountingIterator before = *this;
        ++*this;
        return before;
    }
    bool operator==(const CountingIterator& o) const { return at_ == o.at_; }
    bool operator!=(const CountingIterator& o) const { return at_ != o.at_; }

  private:
    const char* at_;
    int* line_;
};

// The pointer to the value that comes next.
class Position {
  public:
    /// Returns false where no methods file is nested as deep.
    bool open(bool array) {
        levels_.push_back({array, 0, ""});
        return levels_.size() <= max_json_depth;
    }
    void close() { levels_.pop_back(); }
    void key(const std::string& name) { levels_.back().name = name; }
    /// Counts an element of an array; returns false where the value has a key and is known already.
    bool element() {
        if (levels_.empty() || !levels_.back().array) return false;
        levels_.back().name = std::to_string(levels_.back().next++);
        return true;
    }
    std::string pointer() const {
        std::string text;
        for (const Level& level : levels_) text += "/" + level.name;
        return text;
    }

  private:
    struct Level {
        bool array;
        std::size_t next;
        std::string name;
    };
    std::vector<Level> levels_;
};

}  // namespace

JsonLines::JsonLines(const std::string& text, std::string path) : path_(std::move(path)) {
    int line = 1;
    Position position;
    const auto note = [&](int, json::parse_event_t event, json& parsed) {
        using Event = json::parse_event_t;
        if (event == Event::object_end || event == Event::array_end) {
            position.close();
            return true;
        }
        if (event == Event::key) {
            position.key(parsed.get<std::string>());
            if (!lines_.emplace(position.pointer(), line).second)
                throw core::InputError("'" + core::printable(parsed.get<std::string>()) + "' is given twice",
                                       {path_, line});
            return true;
        }
        if (position.element()) lines_[position.pointer()] = line;
        if (event != Event::value && !position.open(event == Event::array_start))
            throw core::InputError(
                "lists and objects are nested more than " + std::to_string(max_json_depth) + " deep",
                {path_, line});
        return true;
    };
    try {
        root_ = json::parse(CountingIterator(text.data(), &line),
                            CountingIterator(text.data() + text.size(), &line), note);
    } catch (const json::exception& error) {
        std::string message = error.what();
        // "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error while ..."
        if (const auto at = message.find(": "); at != std::string::npos) message.erase(0, at + 2);
        throw core::InputError("not JSON: " + core::printable(message, 200), {path_, line});
    }
}

core::SourceLocation JsonLines::where(const std::string& pointer) const {
    const auto it = lines_.find(pointer);
    return {path_, it == lines_.end() ? 1 : it->second};
}

}  // namespace mote::trade
