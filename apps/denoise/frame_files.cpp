#include "apps/denoise/frame_files.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "core/objects/error.h"

namespace mote::apps {

namespace fs = std::filesystem;
using core::InputError;

namespace {

/// The name before the run of #, its length, and the name behind it.
struct Pattern {
    std::string before, after;
    std::size_t digits = 0;

    explicit Pattern(const std::string& name) {
        const std::size_t first = name.find('#'), end = name.find_first_not_of('#', first);
        before = name.substr(0, first), after = end == std::string::npos ? "" : name.substr(end);
        digits = name.size() - before.size() - after.size();
        if (after.find('#') != std::string::npos)
            throw InputError("'" + core::printable(name) + "' has two places for the number of the frame");
    }
};

}  // namespace

bool names_frames(const std::string& pattern) {
    return fs::path(pattern).filename().string().find('#') != std::string::npos;
}

std::string frame_name(const std::string& pattern, long number) {
    const Pattern p(fs::path(pattern).filename().string());
    std::string digits = std::to_string(number);
    if (digits.size() < p.digits) digits.insert(0, p.digits - digits.size(), '0');
    return (fs::path(pattern).parent_path() / (p.before + digits + p.after)).string();
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
