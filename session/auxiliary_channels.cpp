#include "session/auxiliary_channels.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>

#include "core/geometry/bsdf_point.h"
#include "core/render/mirrored_features.h"
#include "core/scene/scene.h"
#include "screenspace/g_buffer/g_buffer.h"
#include "screenspace/ssbc/ssbc_surfaces.h"

namespace mote::session {

namespace {

core::Rgb diffuse_albedo(const core::FirstHit& first) {
    const core::SurfaceHit& hit = first.hit;
    return screenspace::diffuse_reflectance(*hit.shape->bsdf, core::bsdf_point(hit),
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
    for (core::HitFeature& mirrored : core::mirrored_features(scene)) features.push_back(std::move(mirrored));
    return features;
}

std::vector<core::HitFeature> features_by_name(const core::Scene& scene,
                                               std::span<const std::string> requested) {
    if (requested.empty()) return {};
    std::vector<core::HitFeature> features = auxiliary_features(scene);
    std::erase_if(features, [&](const core::HitFeature& f) {  // means over hits need the fraction of hits
        return f.layer.name != core::coverage_layer &&
               std::find(requested.begin(), requested.end(), f.layer.name) == requested.end();
    });
    return features;
}

std::vector<core::HitFeature> features_for_denoising(const core::Scene& scene,
                                                     std::vector<std::string> requested, bool regression) {
    for (const char* name : {"Albedo", "Ns"}) requested.emplace_back(name);
    for (const char* name :
         {"P", "Depth", "Transmittance", "Mirrored.Emission", "Mirrored.Albedo", "Mirrored.P", "Mirrored.Ns"})
        if (regression) requested.emplace_back(name);
    return features_by_name(scene, requested);
}

std::vector<core::HitFeature> wanted_features(const core::Scene& scene,
                                              const std::vector<std::string>& requested, bool auxiliary,
                                              const std::string& denoise) {
    if (auxiliary) return auxiliary_features(scene);
    return denoise.empty() ? features_by_name(scene, requested)
                           : features_for_denoising(scene, requested, denoise == "bmfr");
}

void add_center_channels(core::ImageChannels& image, const core::Scene& scene) {
    const screenspace::GBuffer g =
        screenspace::make_g_buffer(scene, scene.camera(), image.width, image.height);
    add_vectors(image, "Center.P", g.position);
    add_vectors(image, "Center.N", g.geometric_normal);
    image.add_rgb("Center.DiffuseAlbedo", screenspace::ssbc_surfaces(g).reflectance);
}

void add_ids(core::ImageChannels& image, const core::Scene& scene) {
    std::map<const core::Bsdf*, float> materials;
    for (const auto& shape : scene.shapes())
        materials.emplace(shape->bsdf.get(), float(materials.size() + 1));
    const auto width = std::size_t(image.width);
    std::vector<float> objects(width * std::size_t(image.height), 0.0f), seen = objects;
    tbb::parallel_for(std::size_t(0), objects.size(), [&](std::size_t p) {
        const core::Vec2 middle(float(p % width) + 0.5f, float(p / width) + 0.5f);
        core::Rng rng(core::hash_keys(std::uint64_t(p)));
        const auto stop = core::first_stop(scene, scene.camera().sample_ray(middle, core::Vec2(0.5f)), rng);
        if (!stop.hit) return;
        objects[p] = float(stop.hit->shape->index + 1), seen[p] = materials.at(stop.hit->shape->bsdf.get());
    });
    image.add("ObjectId.Y", std::move(objects)), image.add("MaterialId.Y", std::move(seen));
}

}  // namespace mote::session
