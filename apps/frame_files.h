// Pictures of a sequence: names in which the longest run of two # or more holds the frame's number,
// "smoke.####.exr" (core/formats/xml/frame_files.h).
#pragma once

#include <string>
#include <vector>

namespace mote::apps {

struct FrameFile {
    long number = 0;
    std::string path;
};

/// True if the file's name (not its folder's) has a placeholder for the number.
bool names_frames(const std::string& pattern);
/// The name of a frame: as many digits as there are #, filled up with zeros, or more.
std::string frame_name(const std::string& pattern, long number);
/// The files that are there, by their numbers. Throws InputError when there are none.
std::vector<FrameFile> find_frames(const std::string& pattern);

}  // namespace mote::apps
