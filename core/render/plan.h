// Techniques that an integrator will run on a scene, with the reason for every choice, and what it leaves
// out.
#pragma once

#include <string>
#include <vector>

#include "core/film/pass_split.h"

namespace mote::core {

struct PlanEntry {
    std::string topic;   ///< "transmittance", "bound", "light per VPL"
    std::string choice;  ///< "analytic"
    std::string reason;  ///< "every medium is homogeneous"
    std::string cure;    ///< of what is missing by choice: "integrator.compensation.depth=-1"; "" where none
};

/// Techniques of an integrator for a scene, with reasons.
struct Plan {
    std::string integrator;           ///< its type
    std::vector<PlanEntry> runs;      ///< techniques
    std::vector<PlanEntry> left_out;  ///< code and data that this scene does not need
    std::vector<PlanEntry> missing;   ///< transport that this integrator cannot compute in this scene
    std::vector<std::string> costly;  ///< sentences on what takes very long in this scene, with its size
    /// The light that is found so rarely that the spread between passes misses it: no noise is stated. ""
    /// where the spread shows all.
    std::string noise_unknown;
    /// The reason why parts of the passes do not show the error. "" where halves do
    /// (core/metrics/halves_error.h): passes have the light of the scene as their mean, and noise that is
    /// independent from pixel to pixel; or groups (error_by_groups).
    std::string error_unknown = "its passes may err alike, or pixels in common";
    /// Pixels of a pass share noise, which groups of passes show (core/metrics/group_error.h), and passes
    /// estimate what is missing from their mean (Layer::missing).
    bool error_by_groups = false;

    /// Adds to `runs`.
    void run(std::string topic, std::string choice, std::string reason);
    /// Adds to `left_out`.
    void leave_out(std::string topic, std::string choice, std::string reason);
    /// Adds to `missing`.
    void miss(std::string topic, std::string choice, std::string reason, std::string cure = "");
    /// Reason why parts of the passes do not show the error of the image: error_unknown, noise_unknown, or
    /// what is missing. "" where they do.
    std::string no_error_because() const;
    bool error_is_known() const { return no_error_because().empty(); }  ///< true where they show it
    PassSplit split() const;  ///< parts that show it; the whole where it is not known
    /// Messages for the user: a warning for each thing that takes very long or that this integrator cannot
    /// compute, and one line with the switches of a topic for what it leaves out by choice.
    std::vector<std::string> warnings() const;
    /// A table for people.
    std::string to_text() const;
};

}  // namespace mote::core
