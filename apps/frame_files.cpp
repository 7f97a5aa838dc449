#include "apps/frame_files.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "core/formats/xml/frame_files.h"
#include "core/objects/error.h"

namespace mote::apps {

namespace fs = std::filesystem;
using core::InputError;

bool names_frames(const std::string& pattern) {
    return core::frame_placeholder(fs::path(pattern).filename().string()).has_value();
}

std::string frame_name(const std::string& pattern, long number) {
    const fs::path path(pattern);
    const auto name = core::frame_placeholder(path.filename().string());
    return name ? (path.parent_path() / name->with(number)).string() : pattern;
}

std::vector<FrameFile> find_frames(const std::string& pattern) {
    const fs::path folder = fs::path(pattern).parent_path();
    const core::FramePlaceholder p = core::frame_placeholder(fs::path(pattern).filename().string()).value();
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
