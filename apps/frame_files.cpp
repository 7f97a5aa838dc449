#include "apps/frame_files.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "core/formats/xml/frame_files.h"
#include "core/objects/error.h"

namespace mote::apps {

namespace fs = std::filesystem;
using core::InputError;

namespace {

/// The name before the number, how many digits it has at least, and the name behind it.
struct Pattern {
    std::string before, after;
    std::size_t digits = 0;

    explicit Pattern(const std::string& name) {
        // Two numbers of as many digits as there are # differ in nothing but these.
        const std::string zeros = *core::with_frame_number(name, 0);
        std::size_t first = 0;
        while (first < name.size() && name[first] == zeros[first]) ++first;
        digits = name.find_first_not_of('#', first) == std::string::npos
                     ? name.size() - first
                     : name.find_first_not_of('#', first) - first;
        before = name.substr(0, first), after = name.substr(first + digits);
    }
};

}  // namespace

bool names_frames(const std::string& pattern) {
    return core::with_frame_number(fs::path(pattern).filename().string(), 0).has_value();
}

std::string frame_name(const std::string& pattern, long number) {
    const fs::path path(pattern);
    const auto name = core::with_frame_number(path.filename().string(), int(number));
    return name ? (path.parent_path() / *name).string() : pattern;
}

std::vector<FrameFile> find_frames(const std::string& pattern) {
    const fs::path folder = fs::path(pattern).parent_path();
    const Pattern p(fs::path(pattern).filename().string());
    std::vector<FrameFile> frames;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder.empty() ? "." : folder, ignored)) {
        const std::string name = entry.path().filename().string();
        if (!name.starts_with(p.before) || !name.ends_with(p.after)) continue;
        if (name.size() < p.before.size() + p.digits + p.after.size() || name.size() > 200) continue;
        const std::string digits =
            name.substr(p.before.size(), name.size() - p.before.size() - p.after.size());
        if (digits.size() > 9 ||
            !std::all_of(digits.begin(), digits.end(), [](unsigned char c) { return std::isdigit(c) != 0; }))
            continue;
        if (digits.size() > p.digits && digits.front() == '0') continue;  // of another pattern
        frames.push_back({std::stol(digits), (folder / name).string()});
    }
    if (frames.empty()) throw InputError("no file is called " + core::printable(pattern, 300));
    std::sort(frames.begin(), frames.end(),
              [](const FrameFile& a, const FrameFile& b) { return a.number < b.number; });
    return frames;
}

}  // namespace mote::apps
