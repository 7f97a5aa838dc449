#include "core/render/first_hit_features.h"

#include "core/render/camera_ray.h"
#include "core/scene/media_along.h"
#include "core/scene/scene.h"

namespace mote::core {

namespace {

constexpr int tile_size = 16;
constexpr std::uint32_t feature_stream = 0x66656174u;  // keeps its estimates apart from those of the picture

Layer feature_layer(std::string name, std::string description, std::string where = "") {
    return {std::move(name), std::move(description), true, true, std::move(where)};
}

Rgb transmittance(const FirstHit& first) {
    TrackingCounters counters;
    return first.scene.transmittance(first.ray.at(first.ray.t_min), first.hit.position,
                                     first.scene.eye_medium_state(first.ray), first.rng, counters);
}

}  // namespace

Rgb first_hit_albedo(const FirstHit& first) {
    const SurfaceHit& hit = first.hit;
    const Rgb all = hit.shape->bsdf->albedo(bsdf_point(hit), hit.shading.to_local(first.to_viewer()));
    if (!is_pane(hit)) return all;
    return (all - passage_through(hit, first.ray.direction).transmittance()) / first.stop_chance;
}

FirstStop first_stop(const Scene& scene, const Ray& ray, Rng& rng) {
    FirstStop stop{scene.first_hit(ray)};
    if (!scene.has_panes()) return stop;
    Ray before = ray;
    if (stop.hit) before.t_max = stop.hit->t;
    scene.for_each_boundary(before, [&](const SurfaceHit& hit) {
        if (!is_pane(hit) || !hit.shape->bsdf->traits().smooth) return true;
        const StraightPassage passage = passage_through(hit, ray.direction);
        if (rng.next_float() < passage.probability()) return true;
        stop = {hit, passage.stops};
        return false;
    });
    return stop;
}

std::vector<HitFeature> first_hit_features(const Scene& scene) {
    std::vector<HitFeature> features{
        {{coverage_layer, "share of rays that hit a surface", true},
         [](const FirstHit&) { return Rgb(1.0f); }},
        {feature_layer("P", "position of the first hit", coverage_layer),
         [](const FirstHit& f) { return f.hit.position; }},
        {feature_layer("N", "geometric normal, towards the viewer"),
         [](const FirstHit& f) { return f.facing(f.hit.geometric_normal); }},
        {feature_layer("Ns", "shading normal, towards the viewer"),
         [](const FirstHit& f) { return f.facing(f.hit.shading.n); }},
        {feature_layer("Depth", "distance along the ray", coverage_layer),
         [](const FirstHit& f) { return Rgb(f.hit.t); }},
        {feature_layer("Albedo", "of the BSDF, seen from the viewer"), first_hit_albedo}};
    if (scene.has_media())
        features.push_back(
            {feature_layer("Transmittance", "from the camera to the first hit", coverage_layer),
             transmittance});
    return features;
}

FirstHitPass::FirstHitPass(const Scene& scene, const RenderOptions& options, std::vector<HitFeature> features,
                           std::size_t first_layer)
    : scene_(scene), options_(options), features_(std::move(features)), first_layer_(first_layer) {}

bool FirstHitPass::fill(const PassContext& context, PassImage& image) {
    rays_ += std::uint64_t(options_.width) * std::uint64_t(options_.height);
    return for_each_tile(options_.width, options_.height, tile_size, context.cancelled,
                         [&](int x0, int y0, int x1, int y1) {
                             for (int y = y0; y < y1; ++y)
                                 for (int x = x0; x < x1; ++x) fill_pixel(context, image, x, y);
                         });
}

void FirstHitPass::fill_pixel(const PassContext& context, PassImage& image, int x, int y) const {
    const Ray ray = camera_ray(scene_.camera(), options_, context, x, y);
    Rng rng(hash_keys(options_.seed, context.index, pixel_key(options_, x, y), feature_stream));
    const FirstStop stop = first_stop(scene_, ray, rng);
    if (!stop.hit) return;
    const FirstHit first{scene_, ray, *stop.hit, stop.chance, rng};
    for (std::size_t k = 0; k < features_.size(); ++k)
        image.at(first_layer_ + k, x, y) = features_[k].value(first);
}

}  // namespace mote::core
