#include "integrators/hidden_light.h"

#include <array>
#include <chrono>
#include <limits>

#include "integrators/russian_roulette.h"
#include "lights/direct_light.h"
#include "lights/vpl_gather.h"
#include "screenspace/g_buffer.h"
#include "screenspace/ssbc_receivers.h"

namespace mote::integrators {

using namespace core;

namespace {

constexpr int width = lights::ReceiverTile::width;
constexpr std::uint32_t first_stream = 0x68696464;  ///< of samplers, one a side; eye paths have 0

/// A point on a side of a surface, and the media there.
struct HiddenVertex {
    ScatteringVertex vertex;
    MediumState state;
};

/// The surface is that of side 2 k or 2 k - 1: behind layer k, or before it. Nothing where rounding lost it.
std::optional<HiddenVertex> vertex_at(const Scene& scene, const Ray& ray, std::uint32_t side,
                                      WalkContext& walk, std::vector<SurfaceHit>& hits) {
    const std::size_t layer = (side + 1) / 2;
    const bool behind = side % 2 == 0;
    screenspace::peel(scene, ray, int(layer) + 1, hits);
    walk.rays.closest += layer + 1;
    if (hits.size() <= layer) return std::nullopt;
    HiddenVertex result;
    ScatteringVertex& v = result.vertex;
    v.hit = hits[layer], v.position = v.hit.position, v.bsdf = v.hit.shape->bsdf.get();
    v.wo = behind ? ray.direction : -ray.direction;
    if (!scene.has_media()) return result;

    result.state = scene.camera_medium_state();
    Ray to_surface = ray;
    to_surface.t_max = v.hit.t;
    ++walk.rays.boundary;
    scene.rays().all_hits(to_surface, RayTracer::Group::boundaries, walk.boundary_hits);
    hits.resize(behind ? layer + 1 : layer);
    hits.insert(hits.end(), walk.boundary_hits.begin(), walk.boundary_hits.end());
    std::stable_sort(hits.begin(), hits.end(), [](const auto& a, const auto& b) { return a.t < b.t; });
    for (const SurfaceHit& crossed : hits)
        result.state.cross(*crossed.shape, crossed.geometric_normal, ray.direction);
    return result;
}

/// Direct light by both techniques.
template <bool Media>
Rgb direct_light(const Scene& scene, const HiddenVertex& at, Sampler& sampler, WalkContext& walk) {
    PathWeights weights;
    if constexpr (Media) weights.hero = std::min(int(walk.rng.next_float() * 3.0f), 2);
    const Vec2 choices = sampler.next_2d();  // of the light, and of the lobe
    Rgb light =
        lights::sample_light<Media>(scene, at.vertex, weights, at.state, choices.x, sampler.next_2d(), walk);
    const auto next = at.vertex.sample(choices.y, sampler.next_2d(), TransportMode::radiance);
    if (!next || next->delta) return light;
    lights::apply_scattering<Media>(weights, *next, at.vertex.position);
    const Ray ray{at.vertex.ray_origin(next->wi), next->wi};
    const MediumState state = Media ? at.vertex.state_towards(at.state, next->wi) : at.state;
    return light + lights::light_along<Media>(scene, ray, state, weights, &at.vertex.position, walk);
}

}  // namespace

HiddenLight::HiddenLight(const Scene& scene, const RenderOptions& options, const VplSettings& settings,
                         float bound)
    : scene_(scene),
      options_(options),
      layers_(settings.screen_space->layers),
      max_depth_(settings.eye.max_depth),
      bound_(bound) {
    screenspace::SsbcSettings ssbc = settings.screen_space->ssbc;
    ssbc.bound = bound;
    const auto buffers = screenspace::make_g_buffers(scene, options.width, options.height, layers_);
    const auto sides = screenspace::hidden_sides(buffers);
    const auto matter = screenspace::sides_that_matter(screenspace::ssbc_surfaces(buffers[0]), sides, ssbc);
    for (std::uint32_t side = 0; side < sides.size(); ++side) {
        for (const float area : sides[side].area) candidates_ += area > 0.0f;
        const auto pixels = screenspace::cells_along_z_curve(
            options.width, options.height,
            [&](int x, int y) { return matter[side][buffers[0].index(x, y)] != 0; });
        for (const std::uint32_t pixel : pixels) points_.push_back({pixel, side});
    }
}

template <bool Media>
bool HiddenLight::pass(const PassContext& context, const lights::VplSet& vpls, std::size_t first_layer,
                       PassImage& image) {
    if (max_depth_ >= 0 && max_depth_ < 2) return !context.cancelled;
    const auto some = [&](int begin, int, int end, int) {
        gather<Media>(context, vpls, first_layer,
                      std::span(points_).subspan(std::size_t(begin), std::size_t(end - begin)), image);
    };
    return for_each_tile(int(points_.size()), 1, 8 * width, context.cancelled, some);
}

template <bool Media>
void HiddenLight::gather(const PassContext& context, const lights::VplSet& vpls, std::size_t first_layer,
                         std::span<const Point> points, PassImage& image) {
    const auto begin = std::chrono::steady_clock::now();
    const std::int32_t vpl_depth = max_depth_ < 0 ? std::numeric_limits<std::int32_t>::max() : max_depth_ - 2;
    WalkContext walk;
    const auto scratch = std::make_unique<lights::GatherScratch>();
    const auto tile = std::make_unique<lights::ReceiverTile>();
    std::vector<SurfaceHit> hits;
    std::array<HiddenVertex, width> vertices;
    for (; !points.empty(); points = points.subspan(std::min(points.size(), std::size_t(width)))) {
        if (context.cancelled) return;
        const std::size_t count = std::min(points.size(), std::size_t(width));
        std::array<Rgb, width> light{};
        tile->clear();
        for (std::size_t i = 0; i < count; ++i) {
            const Point& p = points[i];
            const Vec2 film(float(p.pixel % std::uint32_t(options_.width)) + 0.5f,
                            float(p.pixel / std::uint32_t(options_.width)) + 0.5f);
            const auto found =
                vertex_at(scene_, scene_.camera().sample_ray(film, Vec2(0.5f)), p.side, walk, hits);
            if (!found || !found->vertex.connectable()) continue;
            vertices[i] = *found;
            Sampler sampler(options_.sampler, options_.seed, context.index, p.pixel, first_stream + p.side);
            walk.rng = sampler.make_rng();
            light[i] = direct_light<Media>(scene_, vertices[i], sampler, walk);
            tile->set(int(i), vertices[i].vertex, Rgb(1.0f), vertices[i].state, Rng(walk.rng.next_u32()),
                      vpl_depth);
        }
        const auto indirect =
            lights::gather(scene_, vpls, {}, bound_, *tile, *scratch, walk.rays, walk.tracking);
        for (std::size_t i = 0; i < count; ++i)
            image.layer(first_layer + points[i].side)[points[i].pixel] = light[i] + indirect[i];
    }
    const std::lock_guard lock(mutex_);
    rays_.add(walk.rays), tracking_.add(walk.tracking);
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void HiddenLight::add_statistics(Statistics& statistics) const {
    statistics.values["hidden_points"] = double(points_.size());
    statistics.values["hidden_points_without_effect"] = double(candidates_ - points_.size());
    statistics.values["hidden_thread_seconds"] += seconds_;
    statistics.rays["closest"] += rays_.closest;
    statistics.rays["occlusion"] += rays_.occlusion;
    if (!scene_.has_media()) return;
    statistics.rays["boundary"] += rays_.boundary;
    statistics.lookups["density"] += tracking_.lookups;
}

template bool HiddenLight::pass<true>(const PassContext&, const lights::VplSet&, std::size_t, PassImage&);
template bool HiddenLight::pass<false>(const PassContext&, const lights::VplSet&, std::size_t, PassImage&);

}  // namespace mote::integrators
