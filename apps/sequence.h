// A sequence of pictures: one parameter of the scene that runs, and an output with #### for the frame's
// number.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace mote::apps {

/// The parameter that runs.
struct RunningParameter {
    std::size_t define = 0;           ///< which of the definitions
    std::vector<std::string> values;  ///< as they stand for it, one a frame
    /// Where all values are whole and not negative they are the frames' numbers; else these count from 0.
    std::vector<int> numbers;
};

/// The definition "name=FIRST:LAST", "name=FIRST:STEP:LAST" or, where none is a range, "name=VALUE,VALUE,..."
/// of numbers. Nothing where there is none. Throws UsageError where two run, for a step that leads away from
/// the end, or for more than a million frames.
std::optional<RunningParameter> running_parameter(const std::vector<std::string>& defines);

}  // namespace mote::apps
