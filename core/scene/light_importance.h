// Importance of clusters of lights (Estevez and Kulla 2018, Eq. 3 and 4), evaluated for eight of them at
// once.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "core/scene/light_bounds.h"

namespace mote::core {

/// Eight clusters, the children of one node, each number of all eight side by side: they are compared with
/// each other and with nothing else. Slots that hold no cluster have no importance.
struct alignas(32) LightClusters {
    static constexpr std::size_t width = 8;
    template <typename T>
    using Each = std::array<T, width>;

    Each<float> center_x{}, center_y{}, center_z{}, half_x{}, half_y{}, half_z{};  ///< of the boxes [m]
    Each<float> axis_x{}, axis_y{}, axis_z{};
    Each<float> radius{}, back{};  ///< of the sphere around the box; LightBounds::back [m]
    Each<float> cos_spread{}, sin_spread{}, cos_reach{};
    Each<float> intensity{};  ///< over that of the brightest of the eight

    LightClusters() = default;
    explicit LightClusters(std::span<const LightBounds> clusters);  ///< at most eight
};

using LightImportances = LightClusters::Each<float>;

/// Estimates of the light from each cluster at a receiver, up to a common factor: intensity, both cosines,
/// 1/d^2. They are 0 only where nothing can arrive, and scenes of any scale give the same ratios.
LightImportances light_importances(const LightClusters& clusters, const LightReceiver& receiver);
/// Estimates along a segment: in the place of 1/d^2 its integral, (theta_b - theta_a) / D.
LightImportances light_importances(const LightClusters& clusters, const LightSegment& segment);

}  // namespace mote::core
