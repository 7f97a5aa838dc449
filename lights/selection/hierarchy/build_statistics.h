// Time and memory of what a selector builds for a pass, as statistics of the render.
#pragma once

#include <algorithm>
#include <chrono>
#include <string>

#include "core/render/statistics.h"

namespace mote::lights {

/// Measures from its construction to built().
class BuildStatistics {
  public:
    /// Adds to seconds[name], and keeps the largest values[name + "_bytes"].
    BuildStatistics(core::Statistics& statistics, std::string name)
        : statistics_(statistics), name_(std::move(name)) {}
    void built(std::size_t bytes) const {
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin_;
        statistics_.seconds[name_] += seconds.count();
        double& largest = statistics_.values[name_ + "_bytes"];
        largest = std::max(largest, double(bytes));
    }

  private:
    core::Statistics& statistics_;
    std::string name_;
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace mote::lights
