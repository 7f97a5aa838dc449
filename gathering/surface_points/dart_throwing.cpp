#include "gathering/surface_points/dart_throwing.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "core/math/bounds.h"
#include "core/math/random.h"

namespace mote::gathering {

using namespace core;

namespace {

constexpr std::uint32_t nothing = 0xffffffffu;
constexpr float shrink = 0.96f;
constexpr std::size_t block = 8192;

/// Chosen points in cells of a grid, found by a hash of the cell.
class PointGrid {
  public:
    PointGrid(std::span<const Vec3> positions, std::span<const Vec3> normals, float cell, std::size_t points)
        : positions_(positions),
          normals_(normals),
          scale_(1.0 / double(cell)),
          heads_(std::bit_ceil(2 * points + 1), nothing),
          next_(positions.size(), nothing) {}

    void add(std::uint32_t candidate) {
        std::uint32_t& head = heads_[slot(cell_of(positions_[candidate]))];
        next_[candidate] = head, head = candidate;
    }
    /// The square of the distance to the nearest point that faces the candidate's way, as far as the 27 cells
    /// around it go, or to any that is nearer than `stop_below`.
    float nearest_squared(std::uint32_t candidate, float stop_below) const {
        const Cell c = cell_of(positions_[candidate]);
        float nearest = infinity;
        for (std::int64_t k = 0; k < 27; ++k) {
            const Cell cell{c.x + k % 3 - 1, c.y + k / 3 % 3 - 1, c.z + k / 9 - 1};
            for (std::uint32_t i = heads_[slot(cell)]; i != nothing; i = next_[i]) {
                const Vec3 apart = positions_[i] - positions_[candidate];
                const float squared = glm::dot(apart, apart);
                if (squared >= nearest || glm::dot(normals_[i], normals_[candidate]) <= 0.0f) continue;
                nearest = squared;
                if (nearest < stop_below) return nearest;
            }
        }
        return nearest;
    }

  private:
    struct Cell {
        std::int64_t x, y, z;
    };
    Cell cell_of(const Vec3& p) const {
        const auto at = [&](float x) { return std::int64_t(std::floor(double(x) * scale_)); };
        return {at(p.x), at(p.y), at(p.z)};
    }
    std::size_t slot(const Cell& c) const {
        const std::uint64_t key = std::uint64_t(c.x) * 0x9e3779b97f4a7c15ull +
                                  std::uint64_t(c.y) * 0xc2b2ae3d27d4eb4full +
                                  std::uint64_t(c.z) * 0x165667b19e3779f9ull;
        return mix_bits(key) & (heads_.size() - 1);
    }

    std::span<const Vec3> positions_, normals_;
    double scale_;
    std::vector<std::uint32_t> heads_, next_;
};

/// Random order within blocks: candidates come along a curve, and what is near is in the cache.
std::vector<std::uint32_t> shuffled(std::size_t count, std::uint64_t seed) {
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    Rng rng(hash_keys(seed, 0x6461727473ull));
    for (std::size_t first = 0; first < count; first += block)
        for (std::size_t i = std::min(block, count - first); i > 1; --i)
            std::swap(order[first + i - 1], order[first + (std::uint64_t(rng.next_u32()) * i >> 32)]);
    return order;
}

}  // namespace

DartThrow throw_darts(std::span<const Vec3> positions, std::span<const Vec3> normals, std::size_t count,
                      double area, std::uint64_t seed, CancelToken cancelled) {
    DartThrow result;
    if (count == 0) return result;
    // The distance of the hexagonal packing.
    const auto largest = float(std::sqrt(2.0 / std::sqrt(3.0) * area / double(count)));
    PointGrid grid(positions, normals, largest, count);
    std::vector<std::uint32_t> waiting = shuffled(positions.size(), seed);
    // A candidate that was too near to a point remains so until the distance has shrunk below that.
    std::vector<float> nearest(positions.size(), infinity);
    for (float distance = largest; result.chosen.size() < count; distance *= shrink) {
        cancelled.check();
        // Coincident candidates remain in the end: they take what places there are.
        if (distance < 1e-3f * largest) distance = 0.0f;
        std::size_t kept = 0;
        for (const std::uint32_t i : waiting) {
            const bool full = result.chosen.size() == count;
            if (!full && nearest[i] >= sqr(distance)) nearest[i] = grid.nearest_squared(i, sqr(distance));
            if (full || nearest[i] < sqr(distance)) {
                waiting[kept++] = i;
                continue;
            }
            result.chosen.push_back(i), grid.add(i);
            result.distance = distance;
        }
        waiting.resize(kept);
    }
    for (const std::uint32_t i : waiting) {
        const float squared = grid.nearest_squared(i, 0.0f);
        if (squared < infinity) result.covering_radius = std::max(result.covering_radius, std::sqrt(squared));
    }
    // Between candidates there are places too: on a square grid as far as half its diagonal.
    result.covering_radius += float(std::sqrt(0.5 * area / double(positions.size())));
    return result;
}

}  // namespace mote::gathering
