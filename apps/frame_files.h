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

/// Is there a place for the number in the file's name (not its folder's)?
bool names_frames(const std::string& pattern);
/// The name of a frame: as many digits as there are #, filled up with zeros, or more.
std::string frame_name(const std::string& pattern, long number);
/// The files that are there, by their numbers. Throws InputError when there are none.
std::vector<FrameFile> find_frames(const std::string& pattern);

}  // namespace mote::apps
