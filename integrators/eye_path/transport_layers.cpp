#include "integrators/eye_path/transport_layers.h"

namespace mote::integrators {

core::Layer transport_layer_of(core::TransportSet cell, const std::string& suffix) {
    static constexpr std::array<const char*, transport_count> descriptions{
        "light sources seen directly or through mirrors and glass", "light scattered once, on a surface",
        "light scattered more than once, first on a surface as seen from the eye",
        "light scattered once, in a medium", "light scattered more than once, first in a medium"};
    core::Layer layer{core::transport_name(cell) + suffix, "", false, false, "", cell};
    for (std::size_t i = 0; i < transport_count; ++i)
        if (TransportSet(Transport(i)).contains(cell)) layer.description = descriptions[i];
    return layer;
}

std::vector<core::Layer> transport_layers(bool media, const std::string& suffix) {
    std::vector<core::Layer> layers;
    for (std::size_t i = 0; i < transport_layer_count(media); ++i) {
        const auto cell = Transport(i);
        const bool far = cell == Transport::indirect || cell == Transport::multiple_scattering;
        layers.push_back(transport_layer_of(cell, far ? suffix : ""));
    }
    return layers;
}

void store(const TransportSum& sum, core::PassImage& image, int x, int y, bool media) {
    for (std::size_t i = 0; i < transport_layer_count(media); ++i) image.at(i, x, y) = sum.light[i];
    image.finish(x, y);
}

}  // namespace mote::integrators
