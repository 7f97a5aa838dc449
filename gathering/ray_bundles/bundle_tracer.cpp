#include "gathering/ray_bundles/bundle_tracer.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include "core/geometry/mesh_checks.h"
#include "core/objects/error.h"
#include "gathering/ray_bundles/bundle_assembly.h"
#include "gathering/ray_bundles/ray_form.h"
#include "gathering/ray_bundles/scan_form.h"

namespace mote::gathering {

using namespace core;

namespace {

/// The scan visits every triangle, which takes 2.8 ns (with one thread of a 2.1 GHz Xeon); where it takes
/// no hit it has been in vain. Rays take more for each hit, from 1.8 times as much where triangles are larger
/// than packets to 700 ns where every ray has triangles of its own. They were faster in a town of 825,000
/// triangles with 183 or more of them a hit (3.1 against 4.6 ms) and in an atrium of 263,000 with 288 (0.58
/// against 0.75 ms), slower with 46 and 74 (8.9 against 6.3 ms, 1.7 against 1.4 ms): mote_study_ray_bundles.
constexpr double triangles_per_hit_for_rays = 120.0;

}  // namespace

BundleTracer::BundleTracer(const SurfaceTriangles& triangles) : triangles_(triangles) {
    if (triangles.size() >= BundleHit::behind_bit)
        throw InputError("more triangles than ray-bundles can number");
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        for (const Vec3& corner : triangles.corners[i]) {
            if (!(max_component(glm::abs(corner)) < largest_coordinate) || !is_finite(corner))
                throw InputError(
                    fmt::format("triangle {} (shape {}) has a corner that is not finite or lies beyond 1e18",
                                i, triangles.shape.size() > i ? triangles.shape[i] : 0));
            bounds_.extend(corner);
        }
        area_ += triangle_area(triangles.corners[i]);
    }
}

BundleTracer::~BundleTracer() = default;

const RayForm& BundleTracer::ray_form() const {
    // Embree builds in parallel; isolated, so that this thread is not given a task that waits for the form.
    std::call_once(ray_form_once_, [&] {
        tbb::this_task_arena::isolate([&] { ray_form_ = std::make_unique<RayForm>(triangles_, bounds_); });
    });
    return *ray_form_;
}

const TriangleCull& BundleTracer::cull() const {
    std::call_once(cull_once_, [&] { cull_ = std::make_unique<TriangleCull>(triangles_, bounds_); });
    return *cull_;
}

RayBundle BundleTracer::trace(const BundleGrid& grid, const BundleSettings& settings) const {
    const double largest_hits =
        area_ / (double(grid.spacing) * double(grid.spacing));  // all surfaces across the rays
    const BundleLimits limits{settings.memory_budget, largest_hits, settings.cancelled};
    const HitOrder order{.coincident = coincidence(grid, bounds_)};
    if (triangles_.size() == 0)
        return assemble_bundle(grid, RayForm::packet_side, {}, limits, scratch_, [](auto, auto, auto&) {});
    if ((settings.form == BundleForm::automatic ? plan(grid) : settings.form) == BundleForm::scan) {
        const ScanForm scan(triangles_, cull(), grid, settings.memory_budget, settings.cancelled);
        if (scan.possible())
            return assemble_bundle(grid, scan.rows_per_band(), order, limits, scratch_,
                                   [&](std::uint32_t begin, std::uint32_t end, HitBand& band) {
                                       scan.scan_rows(begin, end, band);
                                   });
    }
    const RayForm& rays = ray_form();
    return assemble_bundle(grid, RayForm::packet_side, order, limits, scratch_,
                           [&](std::uint32_t begin, std::uint32_t end, HitBand& band) {
                               rays.trace_rows(grid, begin, end, band);
                           });
}

BundleForm BundleTracer::plan(const BundleGrid& grid) const {
    // A surface is met by half of its area's worth of rays on average over directions (Cauchy).
    const double hits = 0.5 * area_ / (double(grid.spacing) * double(grid.spacing));
    return double(triangles_.size()) > triangles_per_hit_for_rays * hits ? BundleForm::rays
                                                                         : BundleForm::scan;
}

}  // namespace mote::gathering
