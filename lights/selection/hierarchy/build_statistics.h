// Time and memory of what a selector builds for a pass, as statistics of the render.
#pragma once

#include <algorithm>
#include <string>

#include "core/render/cpu_clock.h"
#include "core/render/statistics.h"

namespace mote::lights {

/// Measures from its construction to built().
class BuildStatistics {
  public:
    /// Adds to seconds[name], and keeps the largest values[name + "_bytes"].
    BuildStatistics(core::Statistics& statistics, std::string name)
        : statistics_(statistics), name_(std::move(name)) {}
    void built(std::size_t bytes) const {
        statistics_.seconds[name_] += core::wall_seconds() - begin_;
        double& largest = statistics_.values[name_ + "_bytes"];
        largest = std::max(largest, double(bytes));
    }

  private:
    core::Statistics& statistics_;
    std::string name_;
    double begin_ = core::wall_seconds();
};

}  // namespace mote::lights
