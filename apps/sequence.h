// A sequence of pictures: one parameter of the scene that runs, and an output with #### for the frame's
// number.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/render_files.h"

namespace mote::apps {

/// The parameter that runs.
struct RunningParameter {
    std::size_t define = 0;           ///< which of the definitions
    std::vector<std::string> values;  ///< as texts, one a frame
    /// Where all values are whole and not negative they are the frames' numbers; else these count from 0.
    std::vector<int> numbers;
};

/// The definition "name=FIRST:LAST", "name=FIRST:STEP:LAST" or, where none is a range, "name=VALUE,VALUE,..."
/// of numbers. Nothing where there is none. Throws UsageError where two run, for a step that leads away from
/// the end, or for more than a million frames.
std::optional<RunningParameter> running_parameter(const std::vector<std::string>& defines);

/// Shapes and camera of the frame before, for motion vectors; nothing for the first of a sequence.
std::optional<FrameBefore> frame_before(SequenceFrame& sequence);
/// True where this very frame of a sequence was finished before: by its header and the files that its scene
/// was read from, before the scene is loaded. If none has changed, no other belongs to it.
bool finished_before(const RenderArguments& arguments, const RenderFiles& files);

}  // namespace mote::apps
