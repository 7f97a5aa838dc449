// Files of a sequence: names in which a run of # stands for the frame's number, "smoke.####.exr".
#pragma once

#include <string>
#include <vector>

namespace mote::apps {

struct FrameFile {
    long number = 0;
    std::string path;
};

/// Whether the file's name (not its folder's) holds a #.
bool names_frames(const std::string& pattern);
/// The name of a frame: as many digits as there are #, filled up with zeros, or more.
std::string frame_name(const std::string& pattern, long number);
/// The files that are there, by their numbers. Throws InputError when there are none, and
/// when # stands in two places.
std::vector<FrameFile> find_frames(const std::string& pattern);

}  // namespace mote::apps
