#include "integrators/path_tracing/guiding_trials.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/math/trimmed_sum.h"
#include "core/render/counted_work.h"

namespace mote::integrators {

using namespace core;
using lights::GuideParts, lights::LearnedGuide;

namespace {

/// Processor time of paths, in unguided rays: collisions represent lookups of the medium and of the guide.
/// Measured in the smoke room and in fog (docs/methods/guiding.md, "Cost").
double work_of(Statistics s, double ray_work) {
    constexpr double collision = 0.3;
    const double collisions = double(s.lookups["collisions"]);
    s.lookups.clear();
    return ray_work * counted_work(s) + collision * collisions;
}

/// Without the 0.2 % that are largest: a trial is short, and one bright path in a few hundred would decide
/// it.
double sum_without_outliers(std::vector<double> terms) {
    return sum_without_largest(terms, terms.size() / 500);
}

}  // namespace

template <bool Media>
std::vector<float> GuidingTrials<Media>::light_of(const PassOfPaths& pass,
                                                  const lights::ScatteringGuide& guide,
                                                  SharedCounters& counters) {
    std::vector<float> light(pass.paths);
    trace_pass<Media>(scene_, options_, settings_, pass, guide, counters,
                      [&](std::size_t, std::size_t first, EyePacket<Media>& packet) {
                          trace_paths(scene_, settings_, packet);
                          for (std::size_t i = 0; i < EyePacket<Media>::width && first + i < pass.paths; ++i)
                              for (const Rgb& l : packet[int(i)].sum.light) light[first + i] += average(l);
                      });
    return light;
}

template <bool Media>
auto GuidingTrials<Media>::trial(const lights::ScatteringGuide& guide, double ray_work, std::uint32_t begin)
    -> Trial {
    const auto paths = std::size_t(std::max(16, settings_.guiding.paths / 4));
    const auto layout = std::uint32_t(settings_.guiding.passes);
    Trial result;
    SharedCounters own;
    for (std::uint32_t k = 0; k < passes; ++k)
        result.light[k] = light_of({layout + begin + k, layout, paths}, guide, own);
    Statistics statistics;
    own.report(statistics, Media), counters_.add(own);
    result.work = work_of(statistics, ray_work);
    return result;
}

template <bool Media>
double GuidingTrials<Media>::Trial::variance(std::size_t path) const {
    double sum = 0.0, squares = 0.0;
    for (const auto& l : light) sum += double(l[path]), squares += sqr(l[path]);
    return std::max(0.0, squares - sum * sum / passes) / (passes - 1.0);
}

/// Variances of both kinds over the squared mean around each path. That is taken from a run of neighbouring
/// paths: from those of a pixel alone, a bright one would hide itself.
template <bool Media>
std::array<double, 2> GuidingTrials<Media>::relative_variances(const Trial& plain, const Trial& guided) {
    constexpr std::size_t run = 256;
    const std::size_t paths = plain.light.front().size();
    std::vector<double> means;  // of the runs
    for (std::size_t first = 0; first < paths; first += run) {
        const std::size_t end = std::min(first + run, paths);
        double& mean = means.emplace_back(0.0);
        for (std::size_t i = first; i < end; ++i)
            for (std::uint32_t k = 0; k < passes; ++k)
                mean += double(plain.light[k][i]) + double(guided.light[k][i]);
        mean /= 2.0 * passes * double(end - first);
    }
    const double whole = std::accumulate(means.begin(), means.end(), 0.0) / double(means.size());
    std::vector<double> without, with;
    for (std::size_t i = 0; i < paths; ++i) {
        if (!(means[i / run] > 0.0)) continue;
        const double weight = 1.0 / (sqr(means[i / run]) + 0.01 * whole * whole);
        without.push_back(weight * plain.variance(i)), with.push_back(weight * guided.variance(i));
    }
    return {sum_without_outliers(std::move(without)), sum_without_outliers(std::move(with))};
}

template <bool Media>
std::optional<GuideParts> GuidingTrials<Media>::best_of(LearnedGuide& guide, GuideParts largest,
                                                        double limit) {
    if (!plain_) plain_ = trial(lights::no_guide(), 1.0, 0);
    std::optional<GuideParts> best;
    std::uint32_t begin = passes;
    for (const GuideParts parts : {GuideParts::directions, GuideParts::directions_and_vertices}) {
        if (parts > largest) break;
        guide.decide(parts);
        const Trial guided = trial(guide, ray_work_, std::exchange(begin, begin + passes));
        const auto [without, with] = relative_variances(*plain_, guided);
        const double loss = with * guided.work / (without * plain_->work);
        if (loss < limit) limit = loss, best = parts;
    }
    return best;
}

template class GuidingTrials<true>;
template class GuidingTrials<false>;

}  // namespace mote::integrators
