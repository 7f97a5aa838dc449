#include "integrators/upbp/effort_trials.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/render/counted_work.h"
#include "core/render/render_driver.h"

namespace mote::integrators {

using namespace core;

namespace {

constexpr std::uint32_t trial_stream = 0x6566666fu;  // keeps these paths apart from those of the picture
// A few fewer than merge_schedule.h has for the first radius: queries find almost what those of a pass do.
constexpr std::size_t max_paths = 8192;
constexpr int eye_paths = 2048;     // of half a trial; all merge with all light paths of a pass
constexpr int max_pairs = 64;       // of passes, where an image has fewer pixels than that
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
        trial_.rows.resize(std::size_t(rows_ * pairs_));
        for (auto& row : trial_.rows) row.resize(std::size_t(lattice_.columns()));
        for (int pass = 0; pass < 2 * pairs_; ++pass) {
            const std::size_t first_splat = trial_.splats.size();
            replay(pass, std::nullopt, first_splat);
            for (std::size_t t = 0; t < merge_count; ++t)
                if (trial_.work_of_merges.queries[t] > 0.0) replay(pass, Merge(t), first_splat);
        }
        return std::move(trial_);
    }

  private:
    BidirectionalSettings settings_at(const PerMerge& efforts) const {
        return passes_.settings_of(trial_pass, efforts);
    }
    /// Eye paths of every `step_`-th row of the lattice: found(row, column, Contribution).
    template <typename Found>
    MergeWork trace_eye_paths(const PassContext& context, const BidirectionalSettings& settings,
                              const UpbpLights& lights, SharedCounters& counters, const Found& found) {
        std::vector<MergeWork> works((std::size_t(rows_)));
        tbb::parallel_for(0, rows_, [&](int row) {
            WalkContext walk;
            walk.cancelled = options_.cancelled;
            walk.cancelled.check();
            works[std::size_t(row)] = passes_.trace_eye_paths(
                context, settings, lights, walk,
                [&](const auto& visit) {
                    for (int x = 0; x < lattice_.width; x += lattice_.n) visit(x, row * step_ * lattice_.n);
                },
                [&](int x, int, const Contribution& c) { found(row, x / lattice_.n, c); });
            counters.add(walk.rays, walk.tracking);
        });
        MergeWork merges;
        for (const MergeWork& work : works) merges.add(work);
        return merges;
    }
    void take_every_row(int step) { step_ = step, rows_ = (lattice_.rows() + step - 1) / step; }
    double share_of_rows() const { return double(rows_) / lattice_.rows(); }

    /// Counts a pass as the picture has them.
    void count_work() {
        const int step = std::clamp(int(lattice_.size()) / eye_paths, 1, lattice_.rows());
        take_every_row(step);
        pairs_ = std::clamp(eye_paths / (rows_ * lattice_.columns()), 1, max_pairs);
        const PassContext context{0, *filter_, never_};
        UpbpLights lights;
        const BidirectionalSettings at_full = settings_at(full_efforts);
        passes_.trace_light_paths(context, at_full, lights);
        const double of_light = work_of<Media>(passes_.counters()) * share_of_rows();
        SharedCounters eye;
        const MergeWork merges =
            trace_eye_paths(context, at_full, lights, eye, [](int, int, const Contribution&) {});
        trial_.work_of_paths = work_of<Media>(eye) - merges.of_lookups + of_light;
        trial_.work_of_merges = merges;
        // Ratios of work are those of fewer rows too.
        const double most = double(merges.found) * pairs_ / max_merges;
        if (most > 1.0) take_every_row(int(std::min(1e6, std::ceil(step * most))));
        trial_.share_of_splats = share_of_rows();
    }

    /// Traces the same paths again. With a technique left out, which is then in no weight, light that it
    /// finds as well has a higher weight: its share is what that is more.
    void replay(int pass, std::optional<Merge> left_out, std::size_t first_splat) {
        const PassContext context{std::uint32_t(pass), *filter_, never_};
        PerMerge efforts = full_efforts;
        if (left_out) efforts[std::size_t(*left_out)] = 0.0;
        BidirectionalSettings settings = settings_at(efforts);
        settings.merging.always_sought = settings.all_connections = true;
        UpbpLights lights;
        passes_.trace_light_paths(context, settings, lights);
        std::size_t at = first_splat;
        for (const auto& row : lights.splats)
            for (const Splat& splat : row)
                if (on_film(splat)) take(trial_.splats, at++, {.light = average(splat.light)}, left_out);
        const int half = pass % 2, first_row = pass / 2 * rows_;
        std::vector<std::vector<std::size_t>> done((std::size_t(rows_)));
        for (auto& row : done) row.resize(std::size_t(lattice_.columns()));
        SharedCounters unused;
        trace_eye_paths(context, settings, lights, unused, [&](int row, int column, const Contribution& c) {
            const auto r = std::size_t(row), x = std::size_t(column);
            take(trial_.rows[std::size_t(first_row) + r][x][std::size_t(half)], done[r][x]++,
                 {.light = average(c.light),
                  .weight = c.weight,
                  .merge = c.merge,
                  .query = c.query,
                  .needs_ray = by_chance_ && !c.merge && c.s > 0},
                 left_out);
        });
    }
    /// Light paths see a pixel around the film as well.
    bool on_film(const Splat& s) const {
        return s.film.x >= 0.0f && s.film.y >= 0.0f && s.film.x < float(options_.width) &&
               s.film.y < float(options_.height);
    }
    static void take(std::vector<TrialSample>& samples, std::size_t index, const TrialSample& found,
                     std::optional<Merge> left_out) {
        if (!left_out)
            samples.push_back(found);
        else if (TrialSample& full = samples.at(index); full.light > 0.0f)
            full.share[std::size_t(*left_out)] =
                found.light > 0.0f ? std::max(0.0, 1.0 - double(full.light) / double(found.light)) : 1.0;
    }

    RenderOptions options_;
    bool by_chance_;
    PixelLattice lattice_;
    UpbpPasses<Media> passes_;
    std::unique_ptr<PixelFilter> filter_;
    std::atomic<bool> never_{false};
    int step_ = 1, rows_ = 0, pairs_ = 1;
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
