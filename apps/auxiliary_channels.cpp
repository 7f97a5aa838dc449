#include "apps/auxiliary_channels.h"

#include "core/materials/bsdf.h"
#include "core/scene/scene.h"
#include "screenspace/g_buffer/g_buffer.h"
#include "screenspace/ssbc/ssbc_surfaces.h"

namespace mote::apps {

namespace {

core::Rgb diffuse_albedo(const core::FirstHit& first) {
    const core::SurfaceHit& hit = first.hit;
    return screenspace::diffuse_reflectance(*hit.shape->bsdf, core::BsdfPoint{hit.uv},
                                            hit.shading.to_local(first.to_viewer()));
}

void add_vectors(core::ImageChannels& image, const std::string& layer, std::span<const core::Vec3> values) {
    for (int c = 0; c < 3; ++c) {
        std::vector<float> plane(values.size());
        for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = values[i][c];
        image.add(layer + "." + "XYZ"[c], std::move(plane));
    }
}

}  // namespace

std::vector<core::HitFeature> auxiliary_features(const core::Scene& scene) {
    std::vector<core::HitFeature> features = core::first_hit_features(scene);
    features.push_back(
        {{"DiffuseAlbedo", "what the BSDF reflects to all sides alike", true, true}, diffuse_albedo});
    return features;
}

void add_center_channels(core::ImageChannels& image, const core::Scene& scene) {
    const screenspace::GBuffer g = screenspace::make_g_buffer(scene, scene.camera(), image.width, image.height);
    add_vectors(image, "Center.P", g.position);
    add_vectors(image, "Center.N", g.geometric_normal);
    image.add_rgb("Center.DiffuseAlbedo", screenspace::ssbc_surfaces(g).reflectance);
}

}  // namespace mote::apps
