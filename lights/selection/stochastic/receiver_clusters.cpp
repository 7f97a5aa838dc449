#include "lights/selection/stochastic/receiver_clusters.h"

#include <algorithm>

#include "core/math/vectorize.h"
#include "lights/selection/hierarchy/cluster_cosines.h"
#include "lights/selection/hierarchy/difference_box.h"

namespace mote::lights {

using namespace core;

namespace {

constexpr int lanes = ReceiverBounds::width;
constexpr int features = 7;  // position, direction, and whether there is a cosine
/// Groups narrower than this in every feature stay together: 3 % of the lights' diagonal, or 17 degrees.
constexpr float narrow = 0.3f;

using Feature = std::array<float, features>;

Feature feature_of(const ReceiverBounds& x, int i, float per_length) {
    return {per_length * x.lower_x[i],
            per_length * x.lower_y[i],
            per_length * x.lower_z[i],
            x.axis_x[i],
            x.axis_y[i],
            x.axis_z[i],
            4.0f * x.has_cosine[i]};
}

/// Lanes of one cluster, with what they are longest in.
struct Lanes {
    int first, count, longest = 0;
    float extent = 0.0f;
};

Lanes measured(std::span<const int> order, std::span<const Feature> all, int first, int count) {
    Lanes l{first, count};
    for (int k = 0; k < features; ++k) {
        float low = infinity, high = -infinity;
        for (int i = first; i < first + count; ++i) {
            const float v = all[std::size_t(order[std::size_t(i)])][std::size_t(k)];
            low = std::min(low, v), high = std::max(high, v);
        }
        if (high - low > 1.001f * l.extent) l.extent = high - low, l.longest = k;
    }
    return l;
}

/// Number of the sorted lanes before the widest gap; of like ones that in the middle.
template <typename Value>
int widest_gap(std::span<const int> sorted, const Value& value) {
    const auto count = int(sorted.size());
    int best = 1;
    float widest = -1.0f;
    for (int n = 1; n < count; ++n) {
        const float gap = value(sorted[std::size_t(n)]) - value(sorted[std::size_t(n) - 1]);
        if (const float x = gap * float(n * (count - n)); x > widest) widest = x, best = n;
    }
    return best;
}

ReceiverClusters::Cluster united(std::span<const ReceiverBounds> points, std::span<const int> members,
                                 float per_weight) {
    ReceiverClusters::Cluster g{};
    bool alike = true;
    const int one = members.front() % lanes;
    const ReceiverBounds& first = points[std::size_t(members.front() / lanes)];
    g.has_cosine = first.has_cosine[one], g.g_low = first.g_low[one], g.g_high = first.g_high[one];
    g.cone = DirectionCone{{0, 0, 1}, -1.0f};
    for (const int member : members) {
        const ReceiverBounds& x = points[std::size_t(member / lanes)];
        const int i = member % lanes;
        g.box.extend({x.lower_x[i], x.lower_y[i], x.lower_z[i]});
        g.box.extend({x.upper_x[i], x.upper_y[i], x.upper_z[i]});
        alike &= x.has_cosine[i] == g.has_cosine && (x.g_high[i] > 0.0f) == (g.g_high > 0.0f);
        g.g_low = std::min(g.g_low, x.g_low[i]), g.g_high = std::max(g.g_high, x.g_high[i]);
        g.weight += x.weight(i) * per_weight;
        g.max_vpl_depth = std::max(g.max_vpl_depth, float(x.max_vpl_depth[i]));
        g.cone = core::united(g.cone, x.cone(i));
    }
    if (!alike) g.has_cosine = g.g_low = g.g_high = 0.0f, g.cone = DirectionCone::all();
    g.cos_angle = std::cos(g.cone.angle), g.sin_angle = std::max(std::sin(g.cone.angle), 0.0f);
    return g;
}

}  // namespace

ReceiverClusters::ReceiverClusters(const ReceiverBounds& receivers, const WideLightTree& lights)
    : ReceiverClusters(std::span(&receivers, 1), lights) {}

ReceiverClusters::ReceiverClusters(std::span<const ReceiverBounds> points, const WideLightTree& lights) {
    if (lights.empty()) return;
    const Vec3 diagonal = 255.0f * lights.root().step;
    const float length = glm::length(diagonal), per_length = length > 0.0f ? 10.0f / length : 0.0f;
    std::vector<int> order;
    std::vector<Feature> all(points.size() * std::size_t(lanes));
    for (std::size_t p = 0; p < points.size(); ++p)
        for (int i = 0; i < lanes; ++i) {
            if (points[p].max_vpl_depth[i] == 0) continue;
            const int member = int(p) * lanes + i;
            all[std::size_t(member)] = feature_of(points[p], i, per_length);
            order.push_back(member), weight_ += points[p].weight(i);
        }
    if (order.empty()) return;
    std::array<Lanes, max_clusters> parts{measured(order, all, 0, int(order.size()))};
    for (count_ = 1; count_ < max_clusters; ++count_) {
        Lanes& widest = *std::max_element(parts.begin(), parts.begin() + count_,
                                          [](const Lanes& a, const Lanes& b) { return a.extent < b.extent; });
        if (!(widest.extent > narrow)) break;
        const auto value = [&](int i) { return all[std::size_t(i)][std::size_t(widest.longest)]; };
        const auto begin = order.begin() + widest.first, end = begin + widest.count;
        std::sort(begin, end, [&](int a, int b) { return value(a) < value(b); });
        const int n = widest_gap(std::span(begin, end), value);
        parts[std::size_t(count_)] = measured(order, all, widest.first + n, widest.count - n);
        widest = measured(order, all, widest.first, n);
    }
    for (int k = 0; k < count_; ++k) {
        const Lanes& p = parts[std::size_t(k)];
        clusters_[std::size_t(k)] =
            united(points, std::span(order).subspan(std::size_t(p.first), std::size_t(p.count)),
                   weight_ > 0.0f ? 1.0f / weight_ : 0.0f);
    }
}

std::array<float, max_children> importance(const LightChildren& y, const ReceiverClusters& receivers,
                                           float bound) {
    alignas(32) std::array<float, max_children> sum{};
    for (const ReceiverClusters::Cluster& x : receivers.all()) {
        const Vec3 x_lower = x.box.lower, x_upper = x.box.upper, x_axis = x.cone.axis;
        const float x_cos = x.cos_angle, x_sin = x.sin_angle, no_cosine = 1.0f - x.has_cosine;
        const float x_diagonal2 = glm::dot(x_upper - x_lower, x_upper - x_lower), weight = x.weight;
        const float own_bound = bound, depth = x.max_vpl_depth;
        alignas(32) float light[max_children], cosine_x[max_children], cosine_y[max_children];
        MOTE_INDEPENDENT_LANES
        for (int i = 0; i < max_children; ++i) {
            const DifferenceBox d{y.lower_x[i] - x_upper.x, y.lower_y[i] - x_upper.y,
                                  y.lower_z[i] - x_upper.z, y.upper_x[i] - x_lower.x,
                                  y.upper_y[i] - x_lower.y, y.upper_z[i] - x_lower.z};
            const float inv_near = 1.0f / std::sqrt(d.near_squared()),
                        inv_far = 1.0f / std::sqrt(d.far_squared());
            const float to_light = d.largest_along(x_axis.x, x_axis.y, x_axis.z);
            const float to_receiver = d.largest_along(-y.axis_x[i], -y.axis_y[i], -y.axis_z[i]);
            const float cx = largest_cosine(to_light, inv_near, inv_far, x_cos, x_sin);
            const float cy = largest_cosine(to_receiver, inv_near, inv_far, y.cos_angle[i], y.sin_angle[i]);
            const float c_x = max_of(cx, no_cosine), c_y = max_of(cy, 1.0f - y.has_cosine[i]);
            const float dx = y.upper_x[i] - y.lower_x[i], dy = y.upper_y[i] - y.lower_y[i],
                        dz = y.upper_z[i] - y.lower_z[i];
            const float least =
                max_of(0.25f * (dx * dx + dy * dy + dz * dz + x_diagonal2), min_distance_squared);
            const float g =
                min_of(max_of(c_x, 0.0f) * max_of(c_y, 0.0f) / d.middle_squared(least), own_bound);
            light[i] = y.min_depth[i] <= depth ? y.energy_fraction[i] * g * weight : 0.0f;
            cosine_x[i] = cx, cosine_y[i] = cy;
        }
        if (y.any_lobe)
            for (std::size_t i = 0; i < max_children; ++i)
                light[i] *= y.g_high[i] > 0.0f ? largest_lobe(y.g_low[i], y.g_high[i], cosine_y[i]) : 1.0f;
        if (x.g_high > 0.0f)
            for (std::size_t i = 0; i < max_children; ++i)
                light[i] *= largest_lobe(x.g_low, x.g_high, cosine_x[i]);
        for (std::size_t i = 0; i < max_children; ++i) sum[i] += min_of(light[i], 2e35f);
    }
    return sum;
}

}  // namespace mote::lights
