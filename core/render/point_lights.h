// Light of a pixel by the points that brought it: virtual point lights, photons. Methods that have such
// points show them, for a viewer.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/math/vec.h"

namespace mote::core {

struct PassContext;

struct LightPoint {
    Vec3 position;            ///< [m]
    Rgb power{0.0f};          ///< of a photon [W]; of a VPL its intensity [W/sr]
    std::uint32_t depth = 1;  ///< vertices of the light path up to here
};

/// Light of one pixel in one pass.
struct PixelLight {
    struct Source {
        std::size_t index;  ///< among PointLights::points()
        LightPoint point;
        Rgb light{0.0f};      ///< in the pixel's mean, as the image holds it [W/(m^2 sr)]
        double weight = 1.0;  ///< of the point: 1 / p where it was sampled
        /// Points of the cluster that it represents; 0: it represents no cluster.
        std::size_t cluster = 0;
        /// Factor that the bound left of its light, 1 where there is none; NaN where it is not known.
        float bounded = 1.0f;
    };
    std::vector<Source> sources;  ///< whose light is not 0
    std::size_t connected = 0;    ///< points that were connected or looked up for the pixel, dark ones too
    Rgb residual{0.0f};           ///< light of all points that the bound removed
    /// Choices of the method: topic and sentence.
    std::vector<std::pair<std::string, std::string>> facts;
};

/// The points of a method in one view.
class PointLights {
  public:
    virtual ~PointLights() = default;
    virtual std::string kind() const = 0;  ///< "VPL", "photon"
    /// All points of a pass. Throws Cancelled.
    virtual std::vector<LightPoint> points(const PassContext& context) = 0;
    /// Light of pixel (x, y) in a pass.
    virtual PixelLight light_of(const PassContext& context, int x, int y) = 0;
};

}  // namespace mote::core
