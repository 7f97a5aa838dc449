// One-line messages about bad input, and the nearest known name for a misspelt one.
//
// The distance is that of Levenshtein with transpositions of neighbours (Damerau 1964, restricted form), over
// names in lower case without underscores, so that "toWorld" is at distance 0 from "to_world".
#include "core/objects/error.h"

#include <algorithm>
#include <cctype>

namespace mote::core {
namespace {

std::string located(const std::string& message, const SourceLocation& where) {
    std::string text;
    if (!where.file.empty()) text = printable(where.file, 400);
    if (where.line > 0) text += (text.empty() ? "line " : ":") + std::to_string(where.line);
    if (!text.empty()) text += ": ";
    return text + printable(message, 1000);
}

std::string folded(std::string_view name) {
    std::string result;
    for (const char c : name)
        if (c != '_' && c != '-') result += char(std::tolower(static_cast<unsigned char>(c)));
    return result;
}

std::size_t edit_distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replace = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            row[j] = std::min({replace, last[j] + 1, row[j - 1] + 1});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
        std::swap(before, last);
        std::swap(last, row);
    }
    return last[b.size()];
}

/// The number of bytes of a valid UTF-8 sequence of printable meaning at `text[i]`, or 0.
std::size_t utf8_length(std::string_view text, std::size_t i) {
    const auto lead = static_cast<unsigned char>(text[i]);
    std::size_t length = 0;
    if (lead >= 0xc3 && lead < 0xe0) length = 2;  // 0xc2 starts the C1 control characters
    if (lead >= 0xe1 && lead < 0xf0) length = 3;
    if (lead >= 0xf1 && lead < 0xf4) length = 4;
    if (length == 0 || i + length > text.size()) return 0;
    for (std::size_t k = 1; k < length; ++k)
        if ((static_cast<unsigned char>(text[i + k]) & 0xc0) != 0x80) return 0;
    // U+2000..U+206F holds marks that turn the direction of text; keep them off a terminal.
    if (lead == 0xe2 && static_cast<unsigned char>(text[i + 1]) <= 0x81) return 0;
    return length;
}

}  // namespace

InputError::InputError(const std::string& message, const SourceLocation& where)
    : std::runtime_error(located(message, where)), where_(where) {}

std::string nearest_name(std::string_view name, std::span<const std::string> candidates) {
    const std::string wanted = folded(name.substr(0, 64));
    std::string best;
    std::size_t best_distance = std::string::npos;
    for (const std::string& candidate : candidates) {
        const std::string known = folded(candidate);
        const std::size_t d = edit_distance(wanted, known);
        // Near: at most a third of the longer name is wrong, or one holds the whole other.
        const std::size_t longer = std::max(wanted.size(), known.size());
        const bool contained =
            wanted.size() >= 3 && known.size() >= 3 &&
            (known.find(wanted) != std::string::npos || wanted.find(known) != std::string::npos);
        if (!contained && 3 * d > longer + 1) continue;
        if (d < best_distance) best = candidate, best_distance = d;
    }
    return best;
}

std::string suggestion(std::string_view name, std::span<const std::string> candidates) {
    if (candidates.empty()) return "";
    const std::string near = nearest_name(name, candidates);
    if (!near.empty()) return " (did you mean '" + printable(near) + "'?)";
    std::string list;
    for (const std::string& candidate : candidates) {
        if (list.size() > 300) {
            list += ", ...";
            break;
        }
        list += (list.empty() ? "" : ", ") + printable(candidate, 60);
    }
    return " (known: " + list + ")";
}

std::string printable(std::string_view text, std::size_t max_length) {
    std::string result;
    for (std::size_t i = 0; i < text.size();) {
        if (result.size() >= max_length) return result + "...";
        const auto c = static_cast<unsigned char>(text[i]);
        const std::size_t length = c < 0x80 ? 0 : utf8_length(text, i);
        if (length > 0)
            result.append(text.substr(i, length));
        else
            result += c >= 0x20 && c < 0x7f ? char(c) : '?';
        i += std::max<std::size_t>(1, length);
    }
    return result;
}

}  // namespace mote::core
