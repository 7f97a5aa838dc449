// Spatial reuse: what the receivers of the tile before have chosen becomes candidates of this one
// (Bitterli et al. 2020, Sec. 4).
//
// A receiver x (one lane) has two techniques. Its own candidates can be any light with p_hat_x > 0. Those of
// its neighbour z, the same lane of the tile before, have been chosen and looked at by a shadow ray: they can
// be any light with p_hat_z > 0 that z sees, and carry a weight W that is right in the mean for these lights.
// z stands for c tiles, because it had a neighbour, too.
//
// Unbiased: a light y counts with the balance heuristic's weights, in which p_hat, without what a receiver
// does to all light, stands for the density of a technique (Bitterli et al. 2020, Sec. 4; Lin et al. 2022):
//   m_own = p_x(y) / (p_x(y) + c p_z(y) V_z(y)),   m_reused = c p_z(y) V_z(y) / (p_x(y) + c p_z(y) V_z(y)).
// Of what z has chosen V_z is known to be 1. Own candidates are chosen as if it were, and those that were
// chosen and arrive cost a second shadow ray, from z: where it meets something, the light counts
// 1 / m_own times.
//
// Biased: 1/M weights, m_own = 1 / (1 + c) and m_reused = c / (1 + c), whether or not the other technique
// could have found the light (Bitterli et al. 2020, Alg. 4). Light that z does not receive is lost by the
// share of z, and more along a chain of tiles: the mean is too dark where shadows end and surfaces turn, and
// no ray is traced from z.
//
// Either way z is a neighbour only if it is alike: on a surface that faces the same way within 25 degrees, as
// Bitterli et al. 2020 have it, and no farther from the tangent plane of x than that angle.
#pragma once

#include <array>
#include <vector>

#include "lights/selection/kept_receivers.h"

namespace mote::lights {

enum class SpatialReuse : std::uint8_t { none, unbiased, biased };

/// A light that a receiver has chosen and sees.
struct ReusedSample {
    std::uint32_t light;
    float weight;  ///< W
    float target;  ///< p_hat of the receiver, times ResamplingTarget::scale()
};

/// The shares of both techniques, before anything is known of what z sees. They add up to 1.
struct ReuseShares {
    SpatialReuse reuse;
    /// `own`, `other`: scaled targets of x and z; `confidence`: c.
    float of_own(float own, float other, float confidence) const {
        if (reuse == SpatialReuse::biased) return 1.0f / (1.0f + confidence);
        const float both = own + confidence * other;
        return both > 0.0f ? own / both : 1.0f;
    }
    float of_reused(float own, float other, float confidence) const {
        if (reuse == SpatialReuse::biased) return confidence / (1.0f + confidence);
        const float both = own + confidence * other;
        return both > 0.0f ? confidence * other / both : 0.0f;
    }
};

/// May a lane of `x` reuse what the same lane of `z` has chosen?
inline bool alike(const ReceiverLanes& x, const ReceiverLanes& z, int lane) {
    constexpr float cosine = 0.906f, sine = 0.423f;  // of 25 degrees
    const core::Vec3 n = x.geometric_normal(lane), between = z.position(lane) - x.position(lane);
    return glm::dot(n, z.geometric_normal(lane)) > cosine &&
           std::fabs(glm::dot(n, between)) <= sine * glm::length(between);
}

/// The tile before.
struct ReusedTile {
    static constexpr int width = ReceiverTile::width;
    /// c at most: a chain should forget lights that were chosen far away.
    static constexpr float most_tiles = 4.0f;

    KeptReceivers receivers;
    std::array<std::vector<ReusedSample>, width> samples;
    std::array<float, width> confidence{};  ///< c of each lane; 0: there is nothing to reuse
    bool any = false;

    /// Forgets what lanes of `x` may not reuse.
    void keep_alike(const ReceiverLanes& x) {
        for (int i = 0; i < width; ++i)
            if (!alike(x, receivers.tile, i))
                confidence[std::size_t(i)] = 0.0f, samples[std::size_t(i)].clear();
    }
    /// Of lanes that have gathered with the neighbours of these confidences.
    void count_tile(const ReceiverLanes& gathered) {
        any = false;
        for (std::size_t i = 0; i < std::size_t(width); ++i) {
            const bool active = gathered.max_vpl_depth[i] != 0;
            confidence[i] = active ? std::min(confidence[i] + 1.0f, most_tiles) : 0.0f;
            any |= active;
        }
    }
};

}  // namespace mote::lights
