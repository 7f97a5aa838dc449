#include "lights/selection/lightcut.h"

#include <algorithm>
#include <limits>

namespace mote::lights {

using namespace core;

namespace {

/// Pairs parted at once: few enough to part the worst first, enough for batches of shadow rays.
constexpr std::size_t least_parted = GatherScratch::batch;
/// Before so many pairs are there, nothing is estimated of their error: one of them may be most of the sum.
constexpr std::size_t least_cut = 128;
/// The mean square of an estimate is at most its mean times its bound: a light close by may send far more
/// than is expected, seldom. Bounds are far too large for some groups, so they count up to so many
/// expectations.
constexpr float most_above = 8.0f;
/// Of the mean of a tile: what a pixel's light counts at least where errors are relative to it.
constexpr double least_of_mean = 0.05;

}  // namespace

void Lightcut::add_to_total(const Estimate& e, double sign) {
    for (std::size_t i = 0; i < total_.size(); ++i)
        total_[i] += sign * (double(e.r[i]) + double(e.g[i]) + double(e.b[i])) * (1.0 / 3.0);
}

/// A pair is exact where both groups hold one: its error is 0.
void Lightcut::set_pair(GatherPoints& points, std::size_t index, const Pair& pair) {
    const GatherGroup& group = points.group(pair.group);
    pairs_[index] = pair;
    errors_[index] = expected_[index] = {};
    if (pair.lights.has_node())
        if (const SeenCluster* seen = seen_.find(pair.lights.node, std::uint32_t(pair.kind)))
            pairs_[index].seen = *seen;
    if (pair.lights.single() && group.single()) return;
    const LightNode node = lights_.node(pair.lights);
    bound_light(node, group.bounds, bound_.bound, errors_[index], expected_[index]);
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

/// The light that stands for both stands for one part still, with a smaller weight; the other has its own.
void Lightcut::part_lights(GatherPoints& points, std::size_t index) {
    const Pair pair = pairs_[index];
    const LightCluster left = lights_.left(pair.lights), right = lights_.right(pair.lights);
    const bool waits = pair.place == nobody, in_left = waits || pair.place < right.first;
    const LightCluster &heir = in_left ? left : right, &other = in_left ? right : left;
    const SeenCluster seen = pair.seen.of_part();
    if (!waits) scale_estimate(index, lights_.weight(heir) / lights_.weight(pair.lights));
    set_pair(points, index, {pair.group, heir, pair.kind, pair.place, seen});
    add_pair(points, {pair.group, other, pair.kind, nobody, seen});
}

/// Who stands for the points of a lane is one of its left or of its right points, which differs from lane to
/// lane.
void Lightcut::part_points(GatherPoints& points, std::size_t index) {
    const Pair pair = pairs_[index];
    const GatherGroup& group = points.group(pair.group);
    if (pair.place != nobody) {
        add_to_total(estimates_[index], -1.0);
        estimates_[index] = {};
        waiting_.push_back(std::uint32_t(index));
    }
    set_pair(points, index, {group.left, pair.lights, pair.kind, nobody, pair.seen});
    add_pair(points, {group.right, pair.lights, pair.kind, nobody, pair.seen});
}

void Lightcut::part(GatherPoints& points, std::size_t index) {
    const Pair& pair = pairs_[index];
    const GatherGroup& group = points.group(pair.group);
    const bool lights_first =
        pair.lights.single() ? false
                             : group.single() || lights_.node(pair.lights).diagonal2() >= group.diagonal2;
    if (lights_first)
        part_lights(points, index);
    else
        part_points(points, index);
}

/// Whose nodes will be looked at soon.
void Lightcut::part_worst(GatherPoints& points, std::size_t count) {
    constexpr std::size_t ahead = 4;
    for (std::size_t k = 0; k < count; ++k) {
        if (k + 2 * ahead < count) lights_.prefetch_node(pairs_[worst_[k + 2 * ahead].pair].lights);
        if (k + ahead < count) lights_.prefetch(pairs_[worst_[k + ahead].pair].lights);
        part(points, worst_[k].pair);
    }
}

/// A light for each, in proportion to energy. Random numbers are the golden ratio's sequence from a random
/// start: each is even, and pairs that are neighbours in the order of lights have them far apart, so that
/// where light changes evenly over them their errors have opposite signs. What is needed next arrives from
/// memory meanwhile.
void Lightcut::draw(std::span<const std::uint32_t> waiting) {
    constexpr double golden = 0.6180339887498949;
    for (const std::uint32_t index : waiting) lights_.prefetch_places(pairs_[index].lights);
    for (const std::uint32_t index : waiting) {
        Pair& pair = pairs_[index];
        share_ += share_ < 1.0 - golden ? golden : golden - 1.0;
        pair.place = lights_.place_at(pair.lights, share_);
        lights_.prefetch_light_at(pair.place);
    }
    for (const std::uint32_t index : waiting)
        __builtin_prefetch(&vpls_.lights[lights_.light_at(pairs_[index].place)]);
    if (vpls_.details.empty()) return;
    for (const std::uint32_t index : waiting) {
        const std::uint32_t detail = vpls_.lights[lights_.light_at(pairs_[index].place)].detail;
        if (detail != VirtualPointLight::no_detail) __builtin_prefetch(&vpls_.details[detail].vertex);
    }
}

/// What an estimate says of a pair's lights.
void Lightcut::saw(std::size_t index) {
    Pair& pair = pairs_[index];
    const Estimate& e = estimates_[index];
    float arrived = 0.0f;
    for (int i = 0; i < width; ++i) arrived += e.r[i] + e.g[i] + e.b[i];
    const float expected = 3.0f * expected_[index].sum();
    if (!(expected > 0.0f)) return;
    constexpr float most = 10.0f;
    pair.seen.add(std::clamp(arrived / expected, 0.0f, most));
    if (pair.lights.has_node()) seen_.set(pair.lights.node, std::uint32_t(pair.kind), pair.seen);
}

/// Of all pairs that wait.
void Lightcut::evaluate(const GatherContext& context, GatherPoints& points) {
    // In the order of lights, where neighbours are alike.
    std::sort(waiting_.begin(), waiting_.end(), [&](std::uint32_t a, std::uint32_t b) {
        const Pair &p = pairs_[a], &q = pairs_[b];
        return p.group != q.group ? p.group < q.group : p.lights.first < q.lights.first;
    });
    share_ = double(rng_.next_u32()) * 0x1p-32;
    for (std::size_t first = 0; first < waiting_.size(); first += GatherScratch::batch) {
        const auto part =
            std::span(waiting_).subspan(first, std::min(GatherScratch::batch, waiting_.size() - first));
        draw(part);
        for (const std::uint32_t index : part) {
            const Pair& pair = pairs_[index];
            const float weight = lights_.weight(pair.lights) / lights_.weight_at(pair.place);
            const GatherGroup& group = points.group(pair.group);
            estimates_[index] = {};
            if (cut_contributions(vpls_, {lights_.light_at(pair.place), weight}, group.representative,
                                  group.lobes, bound_, context.scratch.packets[in_batch_],
                                  context.scratch.light[in_batch_]))
                batch_[in_batch_++] = index;
            else
                saw(index);
        }
        resolve(context, points);
    }
    counters_.evaluated += waiting_.size();
    waiting_.clear();
}

/// The pairs to part now into worst_, its first `count`: at most `limit` pairs will be.
/// `estimated`: the sum is known, so that parting ends where it is good enough.
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
        const double least = std::max(total, least_of_mean * mean);
        lit += least > 0.0;
        per_total[i] = least > 0.0 ? float(std::min(1.0 / least, double(most))) : 0.0f;
    }
    worst_.clear();
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
        float error = 0.0f, squares = 0.0f, urgency = 0.0f;
        for (int i = 0; i < width; ++i) {
            const float bound = errors_[p].value[std::size_t(i)];
            error = core::max_of(error, bound * inverse[i]);
            const float share = expected_[p].value[std::size_t(i)] * per_total[i];
            squares += share * share;
            urgency += share * core::min_of(bound * per_total[i], most_above * share);
        }
        const float seen = pairs_[p].seen.variance();
        squares = std::min(squares * seen, most);
        variance[p % width] += double(squares);
        if (error > 1.0f) worst_.push_back({std::min(urgency * seen, most), std::uint32_t(p)});
    }
    double sum = 0.0;
    for (const double v : variance) sum += v;
    predicted_ = lit > 0 ? std::sqrt(sum / double(lit)) : 0.0;
    count = 0;
    const bool enough = pairs_.size() >= std::min<std::size_t>(limit, least_cut);
    if (estimated && enough && settings_.threshold > 0.0f && predicted_ <= double(settings_.error))
        worst_.clear();
    const std::size_t room = limit - std::min(limit, pairs_.size());
    count = std::min({worst_.size(), room, std::max(least_parted, worst_.size() / 2)});
    if (count < worst_.size())
        std::nth_element(worst_.begin(), worst_.begin() + std::ptrdiff_t(count), worst_.end(),
                         [](const Worst& a, const Worst& b) {
                             return a.urgency != b.urgency ? a.urgency > b.urgency : a.pair < b.pair;
                         });
}

/// Parts without looking, by what is expected and what tiles before have seen, so that no pair is estimated
/// that is parted anyway.
void Lightcut::plan(GatherPoints& points, std::size_t size) {
    while (pairs_.size() < size) {
        total_ = {};
        for (std::size_t p = 0; p < pairs_.size(); ++p)
            for (std::size_t i = 0; i < total_.size(); ++i)
                total_[i] += double(std::min(expected_[p].value[i], 1e30f) * pairs_[p].seen.mean());
        std::size_t count = 0;
        find_worst(size, false, count);
        if (count == 0) break;
        part_worst(points, count);
    }
    total_ = {};
}

Lightcut::Light Lightcut::gather(const GatherContext& context, GatherPoints& points, const Rng& rng) {
    rng_ = rng;
    pairs_.clear(), errors_.clear(), expected_.clear(), estimates_.clear(), waiting_.clear();
    total_ = {};
    if (lights_.empty()) return {};
    std::size_t kinds = 0;
    for (const GatherKind kind : {GatherKind::surface, GatherKind::medium})
        if (points.root(kind) != GatherPoints::none) {
            add_pair(points, {points.root(kind), lights_.root(), kind, nobody, {}});
            kinds |= std::size_t(1) << std::size_t(kind);
        }
    if (pairs_.empty()) return {};
    if (settings_.threshold > 0.0f) plan(points, planned_[kinds]);
    for (std::size_t count = 0;;) {
        evaluate(context, points);
        find_worst(settings_.max_cut, true, count);
        if (count == 0) break;
        part_worst(points, count);
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
    Light light{};
    for (std::size_t kind = 0; kind < 2; ++kind)
        for (std::size_t i = 0; i < light[kind].size(); ++i) light[kind][i] = Rgb(sum[kind][i]);
    return light;
}

}  // namespace mote::lights
