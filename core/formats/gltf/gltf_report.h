// Content of a glTF file that a scene of ours does not.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace mote::core {

/// Something that changes the picture: what, and what becomes of it where the reader is lenient.
struct GltfFault {
    std::string what, done;
};

struct GltfReport {
    std::vector<GltfFault> faults;
    std::vector<std::string> notes;  ///< information for the user that changes nothing

    /// Each once.
    void fault(const std::string& what, const std::string& done) {
        const auto same = [&](const GltfFault& f) { return f.what == what; };
        if (std::none_of(faults.begin(), faults.end(), same)) faults.push_back({what, done});
    }
    void note(const std::string& text) {
        if (std::find(notes.begin(), notes.end(), text) == notes.end()) notes.push_back(text);
    }
};

}  // namespace mote::core
