#include "integrators/upbp/effort_trials.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/cameras/sensors.h"
#include "core/render/counted_work.h"
#include "core/render/render_driver.h"

namespace mote::integrators {

using namespace core;

namespace {

constexpr std::uint32_t trial_stream = 0x6566666fu;  // keeps these paths apart from those of the picture
// Light paths and pixels of the lattice.
constexpr std::size_t max_paths = 4096;
// Eye paths of half a trial, all of which merge with all light paths of a pass; an image with fewer pixels
// has more pairs of passes.
constexpr std::size_t eye_paths = 2048, max_pairs = 64;
constexpr double max_merges = 1e5;  // of half a trial, which are kept

PixelLattice lattice_of(const RenderOptions& options) {
    PixelLattice lattice{options.width, options.height};
    while (lattice.size() > max_paths) ++lattice.n;
    return lattice;
}
RenderOptions with_own_seed(RenderOptions options) {
    options.seed = hash_keys(options.seed, trial_stream);
    return options;
}

template <bool Media>
double work_of(const SharedCounters& counters) {
    Statistics statistics;
    counters.report(statistics, Media);
    return counted_work(statistics);
}

template <bool Media>
class EffortTrial {
  public:
    EffortTrial(const Scene& scene, const RenderOptions& options, const UpbpSettings& settings)
        : options_(with_own_seed(options)),
          by_chance_(!settings.all_connections),
          lattice_(lattice_of(options)),
          passes_(scene, options_, settings, lattice_),
          filter_(make_pixel_filter("box", 0.5f, 0.5f)) {}

    Trial measure() {
        count_work();
        trial_.pairs = pairs_;
        trial_.pixels.resize(pixels_ * std::size_t(pairs_));
        for (int pass = 0; pass < 2 * pairs_; ++pass) {
            const std::size_t first_splat = trial_.splats.size();
            replay(pass, std::nullopt, first_splat);
            for (std::size_t t = 0; t < technique_count; ++t)
                if (trial_.work.uses(t)) replay(pass, t, first_splat);
        }
        set_weights_by_light(trial_);
        return std::move(trial_);
    }

  private:
    BidirectionalSettings settings_at(const PerTechnique& efforts) const {
        return passes_.settings_of(trial_pass, efforts);
    }
    /// The lattice is cut into runs of `step` pixels, of which each has one eye path.
    void take_one_of(std::size_t step) {
        step_ = std::min(step, lattice_.size());
        pixels_ = lattice_.size() / step_;
    }
    double share_of_pixels() const { return double(pixels_) / double(lattice_.size()); }

    /// Eye paths: found(which pixel, Contribution).
    template <typename Found>
    TechniqueWork trace_eye_paths(const PassContext& context, const BidirectionalSettings& settings,
                                  const UpbpLights& lights, SharedCounters& counters, const Found& found) {
        std::vector<TechniqueWork> works(pixels_);
        tbb::parallel_for(std::size_t(0), pixels_, [&](std::size_t i) {
            WalkContext walk;
            walk.cancelled = options_.cancelled;
            walk.cancelled.check();
            const std::size_t at = i * step_ + hash_keys(trial_stream, i) % step_;
            const auto columns = std::size_t(lattice_.columns());
            const int x = int(at % columns) * lattice_.n, y = int(at / columns) * lattice_.n;
            works[i] = passes_.trace_eye_paths(
                context, settings, lights, walk, [&](const auto& visit) { visit(x, y); },
                [&](int, int, const Contribution& c) { found(i, c); });
            counters.add(walk.rays, walk.tracking);
        });
        TechniqueWork sum;
        for (const TechniqueWork& work : works) sum.add(work);
        return sum;
    }

    /// Counts a pass as the picture has them, and takes fewer pixels where they find too many merges.
    void count_work() {
        take_one_of(std::max<std::size_t>(1, lattice_.size() / eye_paths));
        pairs_ = int(std::clamp<std::size_t>(eye_paths / pixels_, 1, max_pairs));
        const PassContext context{0, *filter_, never_};
        UpbpLights lights;
        const BidirectionalSettings at_full = settings_at(full_efforts);
        passes_.trace_light_paths(context, at_full, lights);
        const double of_light = work_of<Media>(passes_.counters()) * share_of_pixels();
        SharedCounters eye;
        trial_.work = trace_eye_paths(context, at_full, lights, eye, [](std::size_t, const Contribution&) {});
        trial_.work_of_paths = work_of<Media>(eye) - trial_.work.of_pass + of_light;
        // Ratios of work are those of fewer pixels too.
        const double excess = double(trial_.work.merges) * pairs_ / max_merges;
        if (excess > 1.0) take_one_of(std::size_t(std::ceil(double(step_) * excess)));
        trial_.share_of_splats = share_of_pixels();
    }

    /// Traces the same paths again. At half the effort of a technique, light that it finds as well has a
    /// higher weight: its share is twice what that is more.
    void replay(int pass, std::optional<std::size_t> halved, std::size_t first_splat) {
        const PassContext context{std::uint32_t(pass), *filter_, never_};
        PerTechnique efforts = full_efforts;
        if (halved) efforts[*halved] = 0.5;
        BidirectionalSettings settings = settings_at(efforts);
        settings.merging.always_sought = settings.all_connections = true;
        UpbpLights lights;
        passes_.trace_light_paths(context, settings, lights);
        const Vec2 film(float(options_.width), float(options_.height));
        std::size_t at = first_splat;
        for (const auto& row : lights.splats)
            for (const Splat& splat : row)  // light paths see a pixel around the film as well
                if (on_film(splat.film, film, 0.0f)) {
                    if (!halved) trial_.splats.push_back({{}, pixel_of(splat)});
                    take(trial_.splats.at(at++).sample, {.light = average(splat.light)}, halved);
                }
        const std::size_t first_pixel = std::size_t(pass / 2) * pixels_, half = std::size_t(pass % 2);
        std::vector<std::size_t> taken(pixels_);
        SharedCounters unused;
        trace_eye_paths(context, settings, lights, unused, [&](std::size_t i, const Contribution& c) {
            std::vector<TrialSample>& samples = trial_.pixels[first_pixel + i][half];
            if (!halved) samples.emplace_back();
            const auto technique = technique_of(c);
            take(samples.at(taken[i]++),
                 {.light = average(c.light),
                  .weight = c.weight,
                  .technique = technique,
                  .query = c.merge ? c.query : std::uint32_t(c.t),
                  .needs_ray = by_chance_ && technique == by_connection},
                 halved);
        });
    }
    static void take(TrialSample& sample, const TrialSample& found, std::optional<std::size_t> halved) {
        if (!halved)
            sample = found;
        else if (sample.light > 0.0f)
            sample.share[*halved] =
                std::clamp(2.0 * (1.0 - double(sample.light) / double(found.light)), 0.0, 1.0);
    }
    std::size_t pixel_of(const Splat& splat) const {
        const std::size_t index = lattice_.index_of(int(splat.film.x), int(splat.film.y));
        return std::min(index / step_, pixels_ - 1);
    }
    static std::optional<std::size_t> technique_of(const Contribution& c) {
        if (c.merge) return std::size_t(*c.merge);
        return c.s > 0 ? std::optional(by_connection) : std::nullopt;
    }

    RenderOptions options_;
    bool by_chance_;
    PixelLattice lattice_;
    UpbpPasses<Media> passes_;
    std::unique_ptr<PixelFilter> filter_;
    std::atomic<bool> never_{false};
    std::size_t step_ = 1, pixels_ = 0;  ///< that have eye paths
    int pairs_ = 1;
    Trial trial_;
};

}  // namespace

template <bool Media>
Trial trial_of_efforts(const Scene& scene, const RenderOptions& options, const UpbpSettings& settings) {
    return EffortTrial<Media>(scene, options, settings).measure();
}

template Trial trial_of_efforts<true>(const Scene&, const RenderOptions&, const UpbpSettings&);
template Trial trial_of_efforts<false>(const Scene&, const RenderOptions&, const UpbpSettings&);

}  // namespace mote::integrators
