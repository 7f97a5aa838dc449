#include "apps/auxiliary_channels.h"

#include "screenspace/g_buffer/g_buffer.h"
#include "screenspace/ssbc/ssbc_surfaces.h"

namespace mote::apps {

namespace {

void add_vectors(core::ImageChannels& image, const std::string& layer, std::span<const core::Vec3> values) {
    for (int c = 0; c < 3; ++c) {
        std::vector<float> plane(values.size());
        for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = values[i][c];
        image.add(layer + "." + "XYZ"[c], std::move(plane));
    }
}

}  // namespace

void add_auxiliary_channels(core::ImageChannels& image, const core::Scene& scene) {
    const screenspace::GBuffer g =
        screenspace::make_g_buffer(scene, scene.camera(), image.width, image.height);
    add_vectors(image, "P", g.position);
    add_vectors(image, "N", g.geometric_normal);
    add_vectors(image, "Ns", g.shading_normal);
    image.add("Depth.Z", g.distance);
    image.add_rgb("Albedo", g.reflectance);
    image.add_rgb("DiffuseAlbedo", screenspace::ssbc_surfaces(g).reflectance);
}

}  // namespace mote::apps
