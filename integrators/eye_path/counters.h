// Adds up what tasks counted on their own, under one lock a task, and reports it.
#pragma once

#include <mutex>

#include "core/geometry/ray_counters.h"
#include "core/render/statistics.h"
#include "core/scene/medium.h"

namespace mote::integrators {

class SharedCounters {
  public:
    void add(const core::RayCounters& rays, const core::TrackingCounters& tracking) {
        const std::lock_guard lock(mutex_);
        rays_.add(rays);
        tracking_.add(tracking);
    }
    /// All that others counted.
    void add(const SharedCounters& others) { add(others.rays_, others.tracking_); }
    /// `media` = false reports no volume counters at all: nothing was spent on them.
    void report(core::Statistics& statistics, bool media) const {
        statistics.rays["closest"] += rays_.closest;
        statistics.rays["occlusion"] += rays_.occlusion;
        if (!media) return;
        statistics.rays["boundary"] += rays_.boundary;
        statistics.lookups["density"] += tracking_.lookups;
        statistics.lookups["collisions"] += tracking_.collisions;
        statistics.lookups["step_limit_fallbacks"] += tracking_.fallbacks;
    }
    const core::TrackingCounters& tracking() const { return tracking_; }

  private:
    std::mutex mutex_;
    core::RayCounters rays_;
    core::TrackingCounters tracking_;
};

}  // namespace mote::integrators
