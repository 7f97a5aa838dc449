// One estimate of a pixel and the layers of a film, sorted by the cells of the transport
// (core/film/transport.h).
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/film/pass_image.h"

namespace mote::integrators {

using core::Transport, core::TransportSet, core::transport_count, core::transport_layer,
    core::transport_layer_count;

/// One estimate of a pixel, by layer.
struct TransportSum {
    std::array<core::Rgb, transport_count> light{};
    core::Rgb& operator[](Transport t) { return light[std::size_t(t)]; }
    void add(const TransportSum& other) {
        for (std::size_t i = 0; i < transport_count; ++i) light[i] += other.light[i];
    }
};

/// Layer of one cell, named after it.
core::Layer transport_layer_of(TransportSet cell, const std::string& suffix = "");
/// Layers of all cells, in the order of Transport; the two of media are left out where there are none.
/// `suffix` is appended to the names of light that scattered more than once, for methods that change it
/// ("_bounded": the geometry term has a bound).
std::vector<core::Layer> transport_layers(bool media, const std::string& suffix = "");

/// Writes `sum` to pixel (x, y) of the first layers of the image, and says that the pixel is finished.
void store(const TransportSum& sum, core::PassImage& image, int x, int y, bool media);

}  // namespace mote::integrators
