// Which file is which, before anything is written: an output must not be an input, nor another output.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace mote::apps {

/// A file that a command will write or has read, and what it is, for messages: {"the preview", "a.png"}.
struct NamedFile {
    std::string what, path;
};

/// True when both names lead to one file: by links of either kind, by "..", or, where neither is there yet,
/// by folder and name. Devices and pipes are nobody's file.
bool same_file(const std::string& a, const std::string& b);

/// Throws InputError when one of the outputs is one of the inputs, or two outputs are one file.
void check_outputs(std::span<const NamedFile> outputs, std::span<const NamedFile> inputs);
/// Files that a scene was read from, as inputs.
std::vector<NamedFile> scene_inputs(std::span<const std::string> files);

}  // namespace mote::apps
