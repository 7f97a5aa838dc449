// A dense grid of cells with trilinear lookups: the memory of the smoke simulation.
//
// Values stand at cell centres: cell (i, j, k) lies at (i + 0.5, j + 0.5, k + 0.5) in grid coordinates.
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <vector>

#include "core/math/vec.h"

namespace mote::tools {

struct GridSize {
    int x = 0, y = 0, z = 0;
    std::size_t cells() const { return std::size_t(x) * std::size_t(y) * std::size_t(z); }
    std::size_t index(int i, int j, int k) const {
        return (std::size_t(k) * std::size_t(y) + std::size_t(j)) * std::size_t(x) + std::size_t(i);
    }
    friend bool operator==(const GridSize&, const GridSize&) = default;
};

/// Calls body(j, k) for every row of cells, in parallel over slices. Rows must not write what others read.
template <typename Body>
void for_each_row(const GridSize& size, const Body& body) {
    tbb::parallel_for(0, size.z, [&](int k) {
        for (int j = 0; j < size.y; ++j) body(j, k);
    });
}

/// The eight cells around a point; points outside are moved to the border.
struct Stencil {
    std::size_t base;     ///< index of the lowest corner
    std::size_t x, y, z;  ///< steps to the upper corners
    core::Vec3 weight;    ///< of the upper corners

    Stencil(const GridSize& size, const core::Vec3& p) {
        const auto axis = [](float at, int cells, float& w) {
            const float clamped = std::min(std::max(at - 0.5f, 0.0f), float(cells - 1));
            const int lower = std::min(int(clamped), cells - 2);
            w = clamped - float(lower);
            return lower;
        };
        const int i = axis(p.x, size.x, weight.x), j = axis(p.y, size.y, weight.y),
                  k = axis(p.z, size.z, weight.z);
        base = size.index(i, j, k);
        x = 1, y = std::size_t(size.x), z = y * std::size_t(size.y);
    }

    template <typename T>
    T gather(const std::vector<T>& values) const {
        const T* v = values.data() + base;
        const auto mix = [](const T& a, const T& b, float w) { return a + (b - a) * w; };
        const T near = mix(mix(v[0], v[x], weight.x), mix(v[y], v[y + x], weight.x), weight.y);
        const T far = mix(mix(v[z], v[z + x], weight.x), mix(v[z + y], v[z + y + x], weight.x), weight.y);
        return mix(near, far, weight.z);
    }
    /// Smallest and largest of the eight values.
    template <typename T, typename Min, typename Max>
    void range(const std::vector<T>& values, T& low, T& high, const Min& min, const Max& max) const {
        const T* v = values.data() + base;
        low = high = v[0];
        for (const std::size_t c : {x, y, y + x, z, z + x, z + y, z + y + x})
            low = min(low, v[c]), high = max(high, v[c]);
    }
};

}  // namespace mote::tools
