#include "lights/selection/lightcuts/lightcut.h"

#include <algorithm>
#include <limits>

namespace mote::lights {

using namespace core;

namespace {

/// Pairs split at once: few enough to split those of the largest error first, enough for batches of shadow
/// rays.
constexpr std::size_t min_refined = GatherScratch::batch;
/// Before so many pairs are there, nothing is estimated of their error: one of them may hold most of the sum.
constexpr std::size_t min_cut = 128;
/// The mean square of an estimate is at most its mean times its bound: a light close by may send far more
/// than its importance, seldom. Bounds are far too large for some clusters, so they count up to so many
/// importances.
constexpr float max_above = 8.0f;
/// Smallest light of a pixel that errors are relative to, as a fraction of the tile's mean.
constexpr double min_of_mean = 0.05;

}  // namespace

void Lightcut::add_to_total(const Estimate& e, double sign) {
    for (std::size_t i = 0; i < total_.size(); ++i)
        total_[i] += sign * (double(e.r[i]) + double(e.g[i]) + double(e.b[i])) * (1.0 / 3.0);
}

/// A pair of a single VPL and a single tile of points is exact: its error is 0.
void Lightcut::set_pair(GatherPoints& points, std::size_t index, const Pair& pair) {
    const GatherNode& node = points.node(pair.points);
    pairs_[index] = pair;
    errors_[index] = expected_[index] = {};
    if (pair.lights.has_node())
        if (const ClusterStatistics* seen = statistics_.find(pair.lights.node, std::uint32_t(pair.kind)))
            pairs_[index].statistics = *seen;
    if (pair.lights.single() && node.single()) return;
    bound_and_importance(lights_.node(pair.lights), node.bounds, bound_.bound, errors_[index],
                         expected_[index]);
}

void Lightcut::add_pair(GatherPoints& points, const Pair& pair) {
    const std::size_t index = pairs_.size();
    pairs_.emplace_back(), errors_.emplace_back(), expected_.emplace_back(), estimates_.emplace_back();
    set_pair(points, index, pair);
    waiting_.push_back(std::uint32_t(index));
}

void Lightcut::scale_estimate(std::size_t index, float scale) {
    Estimate& e = estimates_[index];
    add_to_total(e, -1.0);
    for (int i = 0; i < width; ++i) e.r[i] *= scale, e.g[i] *= scale, e.b[i] *= scale;
    add_to_total(e, 1.0);
}

/// The child that holds the representative inherits the estimate, with a smaller weight; the other needs its
/// own.
void Lightcut::split_lights(GatherPoints& points, std::size_t index) {
    const Pair pair = pairs_[index];
    const LightCluster left = lights_.left(pair.lights), right = lights_.right(pair.lights);
    const bool waits = pair.representative == no_representative,
               in_left = waits || pair.representative < right.first;
    const LightCluster &heir = in_left ? left : right, &other = in_left ? right : left;
    const ClusterStatistics seen = pair.statistics.of_child();
    if (!waits) scale_estimate(index, lights_.weight(heir) / lights_.weight(pair.lights));
    set_pair(points, index, {pair.points, heir, pair.kind, pair.representative, seen});
    add_pair(points, {pair.points, other, pair.kind, no_representative, seen});
}

/// The representative of a lane's points is one of its left or of its right points, which differs from lane
/// to lane: neither child inherits.
void Lightcut::split_points(GatherPoints& points, std::size_t index) {
    const Pair pair = pairs_[index];
    const GatherNode& node = points.node(pair.points);
    if (pair.representative != no_representative) {
        add_to_total(estimates_[index], -1.0);
        estimates_[index] = {};
        waiting_.push_back(std::uint32_t(index));
    }
    set_pair(points, index, {node.left, pair.lights, pair.kind, no_representative, pair.statistics});
    add_pair(points, {node.right, pair.lights, pair.kind, no_representative, pair.statistics});
}

void Lightcut::split(GatherPoints& points, std::size_t index) {
    const Pair& pair = pairs_[index];
    const GatherNode& node = points.node(pair.points);
    const bool lights_first = pair.lights.single()
                                  ? false
                                  : node.single() || lights_.node(pair.lights).diagonal2() >= node.diagonal2;
    if (lights_first)
        split_lights(points, index);
    else
        split_points(points, index);
}

/// Splits the first `count` of worst_, and prefetches the nodes that the next splits need.
void Lightcut::refine_worst(GatherPoints& points, std::size_t count) {
    constexpr std::size_t ahead = 4;
    for (std::size_t k = 0; k < count; ++k) {
        if (k + 2 * ahead < count) lights_.prefetch_node(pairs_[worst_[k + 2 * ahead].pair].lights);
        if (k + ahead < count) lights_.prefetch(pairs_[worst_[k + ahead].pair].lights);
        split(points, worst_[k].pair);
    }
}

/// Samples a VPL for each pair, in proportion to energy. Random numbers are the golden ratio's sequence from
/// a random start: each is even, and pairs that are neighbours in the order of lights have them far apart, so
/// that where light changes evenly over them their errors have opposite signs. Memory is prefetched a step
/// ahead.
void Lightcut::sample_representatives(std::span<const std::uint32_t> waiting) {
    constexpr double golden = 0.6180339887498949;
    for (const std::uint32_t index : waiting) lights_.prefetch_weights(pairs_[index].lights);
    for (const std::uint32_t index : waiting) {
        Pair& pair = pairs_[index];
        golden_ += golden_ < 1.0 - golden ? golden : golden - 1.0;
        pair.representative = lights_.index_at(pair.lights, golden_);
        lights_.prefetch_light_at(pair.representative);
    }
    for (const std::uint32_t index : waiting)
        __builtin_prefetch(&vpls_.lights[lights_.light_at(pairs_[index].representative)]);
    if (vpls_.details.empty()) return;
    for (const std::uint32_t index : waiting) {
        const std::uint32_t detail = vpls_.lights[lights_.light_at(pairs_[index].representative)].detail;
        if (detail != VirtualPointLight::no_detail) __builtin_prefetch(&vpls_.details[detail].vertex);
    }
}

/// Adds an estimate over its importance to the statistics of the pair's cluster.
void Lightcut::record(std::size_t index) {
    Pair& pair = pairs_[index];
    const Estimate& e = estimates_[index];
    float arrived = 0.0f;
    for (int i = 0; i < width; ++i) arrived += e.r[i] + e.g[i] + e.b[i];
    const float expected = 3.0f * expected_[index].sum();
    if (!(expected > 0.0f)) return;
    constexpr float most = 10.0f;
    pair.statistics.add(std::clamp(arrived / expected, 0.0f, most));
    if (pair.lights.has_node()) statistics_.set(pair.lights.node, std::uint32_t(pair.kind), pair.statistics);
}

/// Estimates all waiting pairs.
void Lightcut::evaluate(const GatherContext& context, GatherPoints& points) {
    // In the order of lights, where neighbours are alike.
    std::sort(waiting_.begin(), waiting_.end(), [&](std::uint32_t a, std::uint32_t b) {
        const Pair &p = pairs_[a], &q = pairs_[b];
        return p.points != q.points ? p.points < q.points : p.lights.first < q.lights.first;
    });
    golden_ = double(rng_.next_u32()) * 0x1p-32;
    for (std::size_t first = 0; first < waiting_.size(); first += GatherScratch::batch) {
        const auto part =
            std::span(waiting_).subspan(first, std::min(GatherScratch::batch, waiting_.size() - first));
        sample_representatives(part);
        for (const std::uint32_t index : part) {
            const Pair& pair = pairs_[index];
            const float weight = lights_.weight(pair.lights) / lights_.weight_at(pair.representative);
            const GatherNode& node = points.node(pair.points);
            estimates_[index] = {};
            if (lobe_contributions(vpls_, {lights_.light_at(pair.representative), weight},
                                   node.representative, node.lobes, bound_,
                                   context.scratch.packets[in_batch_], context.scratch.light[in_batch_]))
                batch_[in_batch_++] = index;
            else
                record(index);
        }
        resolve(context, points);
    }
    counters_.evaluated += waiting_.size();
    waiting_.clear();
}

/// Puts the pairs to split next first in worst_, `count` of them, so that the cut has at most `limit` pairs.
/// `estimated`: the sum is known, and refinement ends where its error is small enough.
void Lightcut::find_worst(std::size_t limit, bool estimated, std::size_t& count) {
    constexpr float most = std::numeric_limits<float>::max();
    double mean = 0.0;
    for (const double t : total_) mean += std::max(t, 0.0) / double(width);
    alignas(64) float inverse[width], per_total[width];
    double variance[width] = {};
    int lit = 0;
    for (int i = 0; i < width; ++i) {
        const double total = std::max(total_[std::size_t(i)], 0.0);
        const double allowed = double(settings_.threshold) * total;
        inverse[i] = allowed > 0.0 ? float(std::min(1.0 / allowed, double(most))) : most;
        // A dark pixel beside bright ones is not what the cut is made for.
        const double least = std::max(total, min_of_mean * mean);
        lit += least > 0.0;
        per_total[i] = least > 0.0 ? float(std::min(1.0 / least, double(most))) : 0.0f;
    }
    worst_.clear();
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
        float error = 0.0f, squares = 0.0f, urgency = 0.0f;
        for (int i = 0; i < width; ++i) {
            const float bound = errors_[p][i];
            error = core::max_of(error, bound * inverse[i]);
            const float fraction = expected_[p][i] * per_total[i];
            squares += fraction * fraction;
            urgency += fraction * core::min_of(bound * per_total[i], max_above * fraction);
        }
        const float seen = pairs_[p].statistics.variance();
        squares = std::min(squares * seen, most);
        variance[p % width] += double(squares);
        if (error > 1.0f) worst_.push_back({std::min(urgency * seen, most), std::uint32_t(p)});
    }
    double sum = 0.0;
    for (const double v : variance) sum += v;
    predicted_ = lit > 0 ? std::sqrt(sum / double(lit)) : 0.0;
    count = 0;
    const bool enough = pairs_.size() >= std::min<std::size_t>(limit, min_cut);
    if (estimated && enough && settings_.threshold > 0.0f && predicted_ <= double(settings_.error))
        worst_.clear();
    const std::size_t room = limit - std::min(limit, pairs_.size());
    count = std::min({worst_.size(), room, std::max(min_refined, worst_.size() / 2)});
    if (count < worst_.size())
        std::nth_element(worst_.begin(), worst_.begin() + std::ptrdiff_t(count), worst_.end(),
                         [](const Worst& a, const Worst& b) {
                             return a.urgency != b.urgency ? a.urgency > b.urgency : a.pair < b.pair;
                         });
}

/// Refines by importance and the statistics of previous tiles alone, so that no pair is estimated that is
/// split anyway.
void Lightcut::plan(GatherPoints& points, std::size_t size) {
    while (pairs_.size() < size) {
        total_ = {};
        for (std::size_t p = 0; p < pairs_.size(); ++p)
            for (std::size_t i = 0; i < total_.size(); ++i)
                total_[i] += double(std::min(expected_[p].value[i], 1e30f) * pairs_[p].statistics.mean());
        std::size_t count = 0;
        find_worst(size, false, count);
        if (count == 0) break;
        refine_worst(points, count);
    }
    total_ = {};
}

std::vector<ChosenVpl> Lightcut::chosen(int lane) const {
    std::vector<ChosenVpl> list;
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
        const Pair& pair = pairs_[p];
        const Estimate& e = estimates_[p];
        list.push_back({lights_.light_at(pair.representative),
                        lights_.weight(pair.lights) / lights_.weight_at(pair.representative),
                        pair.lights.count, Rgb(e.r[lane], e.g[lane], e.b[lane])});
    }
    return list;
}

LightByKind Lightcut::gather(const GatherContext& context, GatherPoints& points, const Rng& rng) {
    rng_ = rng;
    pairs_.clear(), errors_.clear(), expected_.clear(), estimates_.clear(), waiting_.clear();
    total_ = {};
    if (lights_.empty()) return {};
    std::size_t kinds = 0;
    for (const ReceiverKind kind : {ReceiverKind::surface, ReceiverKind::medium})
        if (points.root(kind) != GatherPoints::none) {
            add_pair(points, {points.root(kind), lights_.root(), kind, no_representative, {}});
            kinds |= std::size_t(1) << std::size_t(kind);
        }
    if (pairs_.empty()) return {};
    if (settings_.threshold > 0.0f) plan(points, planned_[kinds]);
    for (std::size_t count = 0;;) {
        evaluate(context, points);
        find_worst(settings_.max_cut, true, count);
        if (count == 0) break;
        refine_worst(points, count);
    }
    planned_[kinds] = pairs_.size() * 3 / 4;
    ++counters_.cuts, counters_.pairs += pairs_.size(), counters_.at_limit += !worst_.empty();
    counters_.predicted_squares += predicted_ * predicted_;
    std::array<std::array<Vec3d, width>, 2> sum{};
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
        auto& of_kind = sum[std::size_t(pairs_[p].kind)];
        const Estimate& e = estimates_[p];
        for (std::size_t i = 0; i < of_kind.size(); ++i) of_kind[i] += Vec3d(e.r[i], e.g[i], e.b[i]);
    }
    LightByKind light{};
    for (std::size_t kind = 0; kind < 2; ++kind)
        for (std::size_t i = 0; i < light[kind].size(); ++i) light[kind][i] = Rgb(sum[kind][i]);
    return light;
}

}  // namespace mote::lights
