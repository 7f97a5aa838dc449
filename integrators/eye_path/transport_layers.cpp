#include "integrators/eye_path/transport_layers.h"

namespace mote::integrators {

const std::string& transport_name(Transport t) {
    static const std::array<std::string, transport_count> names{"emission", "direct", "indirect",
                                                                "single_scattering", "multiple_scattering"};
    return names[std::size_t(t)];
}

WantedTransport wanted_transport(const core::RenderOptions& options) {
    WantedTransport wanted;
    for (std::size_t i = 0; i < transport_count; ++i)
        wanted.of[i] = options.wants(transport_name(Transport(i)));
    return wanted;
}

std::vector<core::Layer> transport_layers(bool media, bool bounded) {
    return suffixed_transport_layers(media, bounded ? "_bounded" : "");
}

std::vector<core::Layer> suffixed_transport_layers(bool media, const std::string& suffix) {
    std::vector<core::Layer> layers = {
        {"emission", "light sources seen directly or through mirrors and glass"},
        {"direct", "light scattered once, on a surface"},
        {"indirect", "light scattered more than once, first on a surface as seen from the eye"}};
    if (media) {
        layers.push_back({"single_scattering", "light scattered once, in a medium"});
        layers.push_back({"multiple_scattering", "light scattered more than once, first in a medium"});
    }
    for (const Transport t : {Transport::indirect, Transport::multiple_scattering})
        if (std::size_t(t) < layers.size()) {
            core::Layer& layer = layers[std::size_t(t)];
            layer.cell = layer.name, layer.name += suffix;
        }
    return layers;
}

void store(const TransportSum& sum, core::PassImage& image, int x, int y, bool media) {
    for (std::size_t i = 0; i < transport_layer_count(media); ++i) image.at(i, x, y) = sum.light[i];
    image.finish(x, y);
}

}  // namespace mote::integrators
