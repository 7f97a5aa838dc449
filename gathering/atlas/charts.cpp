#include "gathering/atlas/charts.h"

#include <algorithm>
#include <numeric>
#include <unordered_map>

#include "core/math/random.h"

namespace mote::gathering {

using namespace core;

namespace {

struct CornerHash {
    std::size_t operator()(const Vec3& p) const {
        const auto bits = [](float x) { return std::uint64_t(std::hash<float>{}(x)); };
        return hash_keys(bits(p.x), bits(p.y), bits(p.z));
    }
};

/// For each edge of each triangle (3 t + e: from corner e to the next) the triangles of the same shape on the
/// other side: entries [first[i], first[i + 1]) of `triangles`.
class Neighbours {
  public:
    explicit Neighbours(const SurfaceTriangles& surfaces) {
        std::unordered_map<Vec3, std::uint32_t, CornerHash> corners;
        const auto number = [&](const Vec3& p) {
            return corners.try_emplace(p + 0.0f, std::uint32_t(corners.size())).first->second;
        };
        for (std::uint32_t t = 0; t < surfaces.size(); ++t) {
            std::array<std::uint32_t, 3> c;
            for (int k = 0; k < 3; ++k) c[std::size_t(k)] = number(surfaces.corners[t][std::size_t(k)]);
            for (std::size_t e = 0; e < 3; ++e) {
                const auto [low, high] = std::minmax(c[e], c[(e + 1) % 3]);
                edges_.push_back({surfaces.shape[t], low, high, t});
            }
        }
        by_key_.resize(edges_.size());
        std::iota(by_key_.begin(), by_key_.end(), 0u);
        std::sort(by_key_.begin(), by_key_.end(), [&](std::uint32_t a, std::uint32_t b) {
            return edges_[a].key() != edges_[b].key() ? edges_[a].key() < edges_[b].key() : a < b;
        });
        place_.resize(edges_.size());
        for (std::uint32_t i = 0; i < by_key_.size(); ++i) place_[by_key_[i]] = i;
    }
    template <typename Visit>
    void for_each(std::uint32_t triangle, const Visit& visit) const {
        for (std::uint32_t e = 3 * triangle; e < 3 * triangle + 3; ++e) {
            for (std::uint32_t i = place_[e]; i-- > 0 && same(i, e);) visit(edges_[by_key_[i]].triangle);
            for (std::uint32_t i = place_[e] + 1; i < by_key_.size() && same(i, e); ++i)
                visit(edges_[by_key_[i]].triangle);
        }
    }

  private:
    struct Edge {
        std::uint32_t shape, low, high, triangle;
        std::array<std::uint32_t, 3> key() const { return {shape, low, high}; }
    };
    bool same(std::uint32_t place, std::uint32_t edge) const {
        return edges_[by_key_[place]].key() == edges_[edge].key();
    }
    std::vector<Edge> edges_;
    std::vector<std::uint32_t> by_key_, place_;
};

/// In double precision, as the square of an area leaves single precision in small scenes.
Vec3d area_vector(const std::array<Vec3, 3>& c) {
    return 0.5 * glm::cross(Vec3d(c[1] - c[0]), Vec3d(c[2] - c[0]));
}

/// Turns the chart so that its rectangle is as small as an edge's direction makes it, and places it.
void fit_rectangle(Chart& chart, const SurfaceTriangles& surfaces, std::span<const std::uint32_t> triangles) {
    const std::size_t tried = triangles.size() > 1000 ? 3 : 32;
    float best = infinity;
    for (std::size_t i = 0; i < std::min(tried, triangles.size()); ++i)
        for (std::size_t e = 0; e < 3; ++e) {
            const auto& c = surfaces.corners[triangles[i]];
            const Vec3 edge = c[(e + 1) % 3] - c[e];
            const Vec3 flat = edge - chart.n * glm::dot(edge, chart.n);
            if (!(glm::dot(flat, flat) > 0.0f)) continue;
            const Vec3 s = glm::normalize(flat), t = glm::cross(chart.n, s);
            Vec2 low(infinity), high(-infinity);
            for (const std::uint32_t k : triangles)
                for (const Vec3& p : surfaces.corners[k]) {
                    const Vec3 from_first = p - surfaces.corners[triangles[0]][0];
                    const Vec2 q(glm::dot(from_first, s), glm::dot(from_first, t));
                    low = glm::min(low, q), high = glm::max(high, q);
                }
            const Vec2 size = high - low;
            if (!(size.x * size.y < best)) continue;
            best = size.x * size.y;
            chart.s = s, chart.t = t, chart.width = size.x, chart.height = size.y;
            chart.origin = surfaces.corners[triangles[0]][0] + s * low.x + t * low.y;
        }
}

}  // namespace

Charts make_charts(const SurfaceTriangles& surfaces, float min_cosine) {
    const Neighbours neighbours(surfaces);
    const std::size_t n = surfaces.size();
    std::vector<Vec3d> areas(n);
    for (std::size_t t = 0; t < n; ++t) areas[t] = area_vector(surfaces.corners[t]);
    const auto area = [&](std::uint32_t t) { return glm::length(areas[t]); };
    std::vector<std::uint32_t> largest_first(n);
    std::iota(largest_first.begin(), largest_first.end(), 0u);
    std::stable_sort(largest_first.begin(), largest_first.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return area(a) > area(b); });
    Charts result;
    result.chart_of.assign(n, Charts::none);
    for (const std::uint32_t seed : largest_first) {
        if (result.chart_of[seed] != Charts::none || !(area(seed) > 0.0)) continue;
        const auto number = std::uint32_t(result.charts.size());
        Chart chart;
        chart.n = Vec3(glm::normalize(areas[seed])), chart.shape = surfaces.shape[seed];
        chart.first = std::uint32_t(result.triangles.size());
        result.triangles.push_back(seed), result.chart_of[seed] = number;
        for (std::size_t i = chart.first; i < result.triangles.size(); ++i)
            neighbours.for_each(result.triangles[i], [&](std::uint32_t t) {
                if (result.chart_of[t] != Charts::none || !(area(t) > 0.0)) return;
                if (!(glm::dot(areas[t], Vec3d(chart.n)) >= double(min_cosine) * area(t))) return;
                result.triangles.push_back(t), result.chart_of[t] = number;
            });
        chart.count = std::uint32_t(result.triangles.size()) - chart.first;
        fit_rectangle(chart, surfaces, result.of(chart));
        result.charts.push_back(chart);
    }
    return result;
}

}  // namespace mote::gathering
