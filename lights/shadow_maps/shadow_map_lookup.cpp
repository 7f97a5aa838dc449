// Lookups in volumetric shadow maps: sixteen at a time as structures of arrays, branch-free, so that
// compilers make vector code of all but the loads.
#include <bit>
#include <cstddef>
#include <cstring>

#include "lights/shadow_maps/volumetric_shadow_map.h"

namespace mote::lights {

using namespace core;

namespace {

/// exp(-x) for x in [0, 32] without a branch; exactly 1 at 0. Relative error below 4e-6.
inline float exp_of_minus(float x) {
    const float y = x * -1.442695041f;
    const auto whole = std::int32_t(y - 0.5f);  // rounded: y is never positive
    const float f = (y - float(whole)) * 0.6931471806f;
    const float power =
        1.0f + f * (1.0f + f * (0.5f + f * (1.0f / 6.0f +
                                            f * (1.0f / 24.0f + f * (1.0f / 120.0f + f * (1.0f / 720.0f))))));
    return power * std::bit_cast<float>((whole + 127) << 23);
}

/// One of the four texels around each of N points.
template <int N>
struct alignas(64) Corner {
    const std::byte* record[N];
    float enter[N], inverse_step[N], plane_x[N], plane_y[N], plane_z[N], limit[N];
    float weight[N];
    std::int32_t k[N];  ///< interval
    float f[N];         ///< fraction within it
    std::int32_t low[N], high[N];

    void load(const std::byte* first, std::size_t record_bytes, const std::int32_t* index) {
        for (int i = 0; i < N; ++i) {
            const std::byte* const from = first + std::size_t(index[i]) * record_bytes;
            const auto number = [from](std::size_t offset) {
                float value;
                std::memcpy(&value, from + offset, sizeof value);
                return value;
            };
            using Header = VolumetricShadowMap::Header;
            record[i] = from;
            enter[i] = number(offsetof(Header, enter));
            inverse_step[i] = number(offsetof(Header, inverse_step));
            plane_x[i] = number(offsetof(Header, plane_x));
            plane_y[i] = number(offsetof(Header, plane_y));
            plane_z[i] = number(offsetof(Header, plane_z));
            limit[i] = number(offsetof(Header, limit));
        }
    }

    /// Bilinear weight, 0 behind the surface.
    void set_weights(const ShadowMapCells<N>& cells, bool right, bool upper) {
        MOTE_INDEPENDENT_LANES
        for (int i = 0; i < N; ++i) {
            const float across = right ? cells.s[i] : 1.0f - cells.s[i];
            const float along = upper ? cells.t[i] : 1.0f - cells.t[i];
            const float height = plane_x[i] * cells.x[i] + plane_y[i] * cells.y[i] + plane_z[i] * cells.z[i];
            weight[i] = height <= limit[i] ? cells.inside[i] * across * along : 0.0f;
        }
    }

    void find_interval(const float* distance, int intervals) {
        const auto end = float(intervals);
        MOTE_INDEPENDENT_LANES
        for (int i = 0; i < N; ++i) {
            const float at = max_of(min_of((distance[i] - enter[i]) * inverse_step[i], end), 0.0f);
            const std::int32_t down = std::int32_t(at);
            k[i] = down < intervals ? down : intervals - 1;
            f[i] = at - float(k[i]);
        }
    }

    /// The values before and after, of the channel whose values start `offset` bytes into the record.
    void load_values(std::size_t offset) {
        for (int i = 0; i < N; ++i) {
            std::uint16_t pair[2];
            std::memcpy(pair, record[i] + offset + 2 * std::size_t(k[i]), sizeof pair);
            low[i] = pair[0], high[i] = pair[1];
        }
    }
};

/// From sums of weights, and of weights times the numbers stored, to transmittances.
template <int N>
void light_left(const float* sum, const float* weight, float* light) {
    MOTE_INDEPENDENT_LANES
    for (int i = 0; i < N; ++i) {
        const float visible = min_of(weight[i], 1.0f), mean = sum[i] / max_of(weight[i], 1e-20f);
        const float depth = min_of(VolumetricShadowMap::depth_unit * mean, 32.0f);
        const float any = depth < 31.0f ? 1.0f : 0.0f;  // a factor: a choice would be a branch
        light[i] = any * visible * exp_of_minus(depth);
    }
}

}  // namespace

template <int N>
void VolumetricShadowMap::look_up(const ShadowMapCells<N>& cells, float* r, float* g, float* b) const {
    const std::size_t bytes = blocks_ * sizeof(Block), row = std::size_t(view_.size + 2) * bytes;
    const std::size_t values = settings_.values(), first = sizeof(Header);
    alignas(64) float weight[N] = {}, depth[3][N] = {};
    Corner<N> corner;
    for (int c = 0; c < 4; ++c) {
        const bool right = c & 1, upper = c & 2;
        corner.load(records_.data()->bytes + (right ? bytes : 0) + (upper ? row : 0), bytes, cells.corner);
        corner.set_weights(cells, right, upper);
        corner.find_interval(cells.distance, settings_.intervals);
        for (std::size_t channel = 0; channel < channels_; ++channel) {
            corner.load_values(first + 2 * channel * values);
            MOTE_INDEPENDENT_LANES
            for (int i = 0; i < N; ++i)
                depth[channel][i] += corner.weight[i] * (float(corner.low[i]) +
                                                         corner.f[i] * float(corner.high[i] - corner.low[i]));
        }
        for (int i = 0; i < N; ++i) weight[i] += corner.weight[i];
    }
    float* const out[3] = {r, g, b};
    for (std::size_t channel = 0; channel < channels_; ++channel)
        light_left<N>(depth[channel], weight, out[channel]);
    if (channels_ == 1)
        for (int i = 0; i < N; ++i) g[i] = b[i] = r[i];
}

void VolumetricShadowMap::prefetch(const ShadowMapCells<ShadowLookup::width>& cells) const {
    const std::size_t bytes = blocks_ * sizeof(Block), row = std::size_t(view_.size + 2) * bytes;
    constexpr std::size_t cache_line = 64;
    for (const std::int32_t corner : cells.corner) {
        const std::byte* texel = record(std::size_t(corner));
        for (std::size_t at = 0; at < 2 * bytes; at += cache_line) {
            __builtin_prefetch(texel + at);
            __builtin_prefetch(texel + row + at);
        }
    }
}

void VolumetricShadowMap::look_up(std::span<ShadowLookup> packets) const {
    constexpr int width = ShadowLookup::width;
    ShadowMapCells<width> cells[2];
    const auto locate = [&](std::size_t p) {
        find_cells<width>(view_, packets[p].x, packets[p].y, packets[p].z, cells[p % 2]);
        prefetch(cells[p % 2]);
    };
    if (!packets.empty()) locate(0);
    for (std::size_t p = 0; p < packets.size(); ++p) {
        if (p + 1 < packets.size()) locate(p + 1);  // its texels are on their way meanwhile
        look_up<width>(cells[p % 2], packets[p].r, packets[p].g, packets[p].b);
    }
}

Rgb VolumetricShadowMap::transmittance(const Vec3& p) const {
    ShadowMapCells<1> cell;
    find_cells<1>(view_, &p.x, &p.y, &p.z, cell);
    Rgb result;
    look_up<1>(cell, &result.x, &result.y, &result.z);
    return result;
}

}  // namespace mote::lights
