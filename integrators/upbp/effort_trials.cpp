#include "integrators/upbp/effort_trials.h"

#include <tbb/parallel_for.h>

#include "core/render/counted_work.h"
#include "core/render/render_driver.h"

namespace mote::integrators {

using namespace core;

namespace {

constexpr std::uint32_t trial_stream = 0x6566666fu;  // keeps these paths apart from those of the picture
// With fewer than merge_schedule.h has for the first radius, queries would find less than those of a pass.
constexpr std::size_t max_paths = 16384;
constexpr int row_step = 4;  // of rows that have eye paths

PixelLattice lattice_of(const RenderOptions& options) {
    PixelLattice lattice{options.width, options.height};
    while (lattice.size() > max_paths) ++lattice.n;
    return lattice;
}

template <bool Media>
double work_of(const SharedCounters& counters) {
    Statistics statistics;
    counters.report(statistics, Media);
    return counted_work(statistics);
}

}  // namespace

template <bool Media>
PerMerge efforts_by_trial(const Scene& scene, const RenderOptions& options, const UpbpSettings& settings) {
    RenderOptions own = options;
    own.seed = hash_keys(options.seed, trial_stream);
    const PixelLattice lattice = lattice_of(options);
    UpbpPasses<Media> passes(scene, own, settings, lattice);
    const auto filter = make_pixel_filter("box", 0.5f, 0.5f);
    const std::atomic<bool> never{false};
    const PassContext context{0, *filter, never};
    const BidirectionalSettings at_full = passes.settings_of(0, full_efforts);
    UpbpLights lights;
    passes.trace_light_paths(context, at_full, lights);
    const int rows = (lattice.rows() + row_step - 1) / row_step;
    std::vector<MergeWork> works((std::size_t(rows)));
    SharedCounters eye;
    tbb::parallel_for(0, rows, [&](int row) {
        WalkContext walk;
        walk.cancelled = options.cancelled;
        works[std::size_t(row)] = passes.trace_eye_paths(
            context, at_full, lights, walk,
            [&](const auto& visit) {
                for (int x = 0; x < lattice.width; x += lattice.n) visit(x, row * row_step * lattice.n);
            },
            [](int, int, const Contribution&) {});
        eye.add(walk.rays, walk.tracking);
    });
    MergeWork merges;
    for (const MergeWork& w : works) merges.add(w);
    const double light_share = double(rows) / lattice.rows();  // of the light paths' work
    return affordable_efforts(
        merges, work_of<Media>(eye) - merges.of_lookups + light_share * work_of<Media>(passes.counters()));
}

template PerMerge efforts_by_trial<true>(const Scene&, const RenderOptions&, const UpbpSettings&);
template PerMerge efforts_by_trial<false>(const Scene&, const RenderOptions&, const UpbpSettings&);

}  // namespace mote::integrators
