#include "integrators/upbp/effort_trials.h"

#include <tbb/parallel_for.h>

#include "core/render/counted_work.h"
#include "core/render/render_driver.h"

namespace mote::integrators {

using namespace core;

namespace {

constexpr std::uint32_t trial_stream = 0x6566666fu;  // keeps these paths apart from those of the picture
constexpr int rounds = 2, passes = 3;                // of each round, with the same efforts
constexpr std::size_t most_paths = 8192;             // of a pass

PixelLattice lattice_of(const RenderOptions& options) {
    PixelLattice lattice{options.width, options.height};
    while (lattice.size() > most_paths) ++lattice.n;
    return lattice;
}

/// Whose light it is; no effort of its own: light that was hit.
std::optional<std::size_t> technique_of(const Contribution& c) {
    if (c.merge) return std::size_t(*c.merge);
    if (c.s == 0) return std::nullopt;
    return c.s == 1 ? light_technique : connection_technique;
}

/// Light of the pixels of a lattice in the passes of a round, mean over channels.
class TrialLight {
  public:
    explicit TrialLight(std::size_t pixels) : light_(pixels) {}

    void add(std::size_t index, int pass, const Contribution& c) {
        const double l = double(average(c.light));
        Pixel& pixel = light_[index];
        pixel.all[std::size_t(pass)] += l;
        const std::optional<std::size_t> technique = technique_of(c);
        if (!technique) return;
        if (!c.merge || pixel.query != c.query) pixel.finish_query();
        pixel.query = c.query, pixel.technique = *technique;
        pixel.found.add(l, double(c.weight), double(c.chance));
    }
    void add_splat(std::size_t index, int pass, const Rgb& light) {
        light_[index].all[std::size_t(pass)] += double(average(light));
    }
    void finish_pass() {
        for (Pixel& pixel : light_) pixel.finish_query();
    }
    /// Moments over the squared mean around each pixel, which is taken from a run of pixels: from one alone a
    /// bright path would hide itself.
    EffortTrial moments() const {
        constexpr std::size_t run = 64;
        std::vector<double> means;
        for (std::size_t first = 0; first < light_.size(); first += run)
            means.push_back(mean_of(first, std::min(first + run, light_.size())));
        double whole = 0.0;
        for (const double m : means) whole += m / double(means.size());
        EffortTrial trial;
        for (std::size_t p = 0; p < light_.size(); ++p)
            if (const double m = means[p / run]; whole > 0.0)
                add_pixel(light_[p], 1.0 / (m * m + 0.01 * whole * whole), trial);
        return trial;
    }

  private:
    struct Pixel {
        std::array<double, passes> all{};
        PerTechnique benefit{};
        std::uint32_t query = 0;  ///< that has `found`
        std::size_t technique = 0;
        QuerySums found{};

        void finish_query() {
            benefit[technique] += found.benefit();
            query = 0, found = {};
        }
    };
    double mean_of(std::size_t first, std::size_t end) const {
        double sum = 0.0;
        for (std::size_t p = first; p < end; ++p)
            for (const double l : light_[p].all) sum += l;
        return sum / double(passes * (end - first));
    }
    static void add_pixel(const Pixel& pixel, double weight, EffortTrial& trial) {
        double sum = 0.0, squares = 0.0;
        for (const double l : pixel.all) sum += l, squares += l * l;
        trial.variance += weight * std::max(0.0, squares - sum * sum / passes) / (passes - 1.0);
        for (std::size_t t = 0; t < technique_count; ++t)
            trial.benefit[t] += weight * pixel.benefit[t] / passes;
    }

    std::vector<Pixel> light_;
};

template <bool Media>
class Trials {
  public:
    Trials(const Scene& scene, const RenderOptions& options, const UpbpSettings& settings)
        : options_(options), lattice_(lattice_of(options)), passes_(scene, options, settings, lattice_) {}

    /// Of a round.
    EffortTrial trial(int round, const PerTechnique& efforts) {
        TrialLight light(lattice_.size());
        TechniqueWork merges;
        for (int k = 0; k < passes; ++k) merges.add(pass(round * passes + k, k, efforts, light));
        EffortTrial trial = light.moments();
        Statistics statistics;
        counters_.report(statistics, Media), passes_.counters().report(statistics, Media);
        trial.technique_work = merges.hits;
        trial.work = counted_work(statistics) - work_before_;
        work_before_ += trial.work;
        for (std::size_t t = 0; t < merge_count; ++t) trial.work += merges.hits[t];
        if (getenv("DBG")) {
            fprintf(stderr, "V %g W %g\n", trial.variance, trial.work);
            for (size_t t = 0; t < technique_count; ++t)
                fprintf(stderr, "  %s B/V %.4f C/W %.4f q %.3f\n", technique_names[t],
                        trial.benefit[t] / trial.variance, merges.hits[t] / trial.work, efforts[t]);
        }
        return trial;
    }
    void report(SharedCounters& counters) const { counters.add(counters_), counters.add(passes_.counters()); }

  private:
    TechniqueWork pass(int index, int k, const PerTechnique& efforts, TrialLight& light) {
        const std::atomic<bool> never{false};
        const PassContext context{std::uint32_t(index), *filter_, never};
        const BidirectionalSettings settings = passes_.settings_of(0, efforts);
        UpbpLights lights;
        passes_.trace_light_paths(context, settings, lights);
        std::vector<TechniqueWork> works(std::size_t(lattice_.rows()));
        tbb::parallel_for(0, lattice_.rows(), [&](int row) {
            WalkContext walk;
            walk.cancelled = options_.cancelled;
            works[std::size_t(row)] = passes_.trace_eye_paths(
                context, settings, lights, walk,
                [&](const auto& visit) {
                    for (int x = 0; x < lattice_.width; x += lattice_.n) visit(x, row * lattice_.n);
                },
                [&](int x, int y, const Contribution& c) { light.add(lattice_.index_of(x, y), k, c); });
            counters_.add(walk.rays, walk.tracking);
        });
        for (const std::vector<Splat>& row : lights.splats)
            for (const Splat& s : row)
                if (const int x = int(s.film.x), y = int(s.film.y);
                    s.film.x >= 0.0f && s.film.y >= 0.0f && x < lattice_.width && y < lattice_.height)
                    light.add_splat(lattice_.index_of(x, y), k, s.light);
        light.finish_pass();
        TechniqueWork sum;
        for (const TechniqueWork& w : works) sum.add(w);
        return sum;
    }

    RenderOptions options_;
    PixelLattice lattice_;
    UpbpPasses<Media> passes_;
    SharedCounters counters_;
    std::unique_ptr<PixelFilter> filter_ = make_pixel_filter("box", 0.5f, 0.5f);
    double work_before_ = 0.0;
};

}  // namespace

template <bool Media>
PerTechnique efforts_by_trials(const Scene& scene, const RenderOptions& options, const UpbpSettings& settings,
                               SharedCounters& counters) {
    RenderOptions own = options;
    own.seed = hash_keys(options.seed, trial_stream);
    Trials<Media> trials(scene, own, settings);
    PerTechnique efforts = full_efforts;
    for (int round = 0; round < rounds; ++round)
        efforts = best_efforts(efforts, trials.trial(round, efforts));
    trials.report(counters);
    return efforts;
}

template PerTechnique efforts_by_trials<true>(const Scene&, const RenderOptions&, const UpbpSettings&,
                                              SharedCounters&);
template PerTechnique efforts_by_trials<false>(const Scene&, const RenderOptions&, const UpbpSettings&,
                                               SharedCounters&);

}  // namespace mote::integrators
