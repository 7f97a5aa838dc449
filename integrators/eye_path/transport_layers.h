// The layers that all integrators of this folder share: light sorted by where the eye path first scatters.
//
//   emission               seen directly, through delta surfaces too, and emission of media in view
//   direct                 one scattering, on a surface
//   single_scattering      one scattering, in a medium
//   indirect               more scatterings, the first on a surface
//   multiple_scattering    more scatterings, the first in a medium
// Scatterings are counted from the first vertex that is not a delta reflection or refraction. Engelhardt 2013
// has the last two in Eq. 10.6, direct light and single scattering in Eq. 10.7, and their sum in Eq. 10.8.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/render/integrator.h"

namespace mote::integrators {

enum class Transport : std::uint8_t { emission, direct, indirect, single_scattering, multiple_scattering };
inline constexpr std::size_t transport_count = 5;

/// The layer of light that scattered `scatterings` times, first on a surface or in a medium as seen from the
/// eye.
constexpr Transport transport_layer(int scatterings, bool surface_first) {
    if (scatterings == 0) return Transport::emission;
    if (scatterings == 1) return surface_first ? Transport::direct : Transport::single_scattering;
    return surface_first ? Transport::indirect : Transport::multiple_scattering;
}

/// How many of them a scene has: those of media come last.
constexpr std::size_t transport_layer_count(bool media) { return media ? transport_count : 3; }

/// The cells of the transport that a method is asked for (RenderOptions::cells).
struct WantedTransport {
    std::array<bool, transport_count> of{true, true, true, true, true};
    bool operator[](Transport t) const { return of[std::size_t(t)]; }
};
WantedTransport wanted_transport(const core::RenderOptions& options);

/// One estimate of a pixel, by layer.
struct TransportSum {
    std::array<core::Rgb, transport_count> light{};
    core::Rgb& operator[](Transport t) { return light[std::size_t(t)]; }
};

/// "direct", "multiple_scattering": the name of a cell, and of the layer that holds all of it.
const std::string& transport_name(Transport t);

/// The layers in the order of Transport; the two of media are left out where there are none. `bounded`
/// renames the layers that a bound on the geometry term darkens.
std::vector<core::Layer> transport_layers(bool media, bool bounded);
/// The same with any suffix on the names of those layers, for methods that change them in another way.
std::vector<core::Layer> suffixed_transport_layers(bool media, const std::string& suffix);

/// Writes `sum` to pixel (x, y) of the first layers of the image, and says that the pixel is finished.
void store(const TransportSum& sum, core::PassImage& image, int x, int y, bool media);

}  // namespace mote::integrators
