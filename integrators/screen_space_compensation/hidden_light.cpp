#include "integrators/screen_space_compensation/hidden_light.h"

#include <array>
#include <limits>
#include <optional>

#include "core/render/cpu_clock.h"
#include "core/scene/scattering_vertex.h"
#include "core/scene/scene.h"
#include "integrators/eye_path/scattered_light.h"
#include "lights/virtual_lights/vpl_gather.h"
#include "screenspace/g_buffer/g_buffer.h"
#include "screenspace/ssbc/ssbc_receivers.h"

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

/// Surfaces and media along the ray of one pixel, kept while its sides follow each other.
class PixelRay {
  public:
    PixelRay(const Scene& scene, int layers, WalkContext& walk)
        : scene_(scene), layers_(layers), walk_(walk) {}

    void aim(std::uint32_t pixel, int columns) {
        if (pixel == pixel_) return;
        pixel_ = pixel;
        const Vec2 film(float(pixel % std::uint32_t(columns)) + 0.5f,
                        float(pixel / std::uint32_t(columns)) + 0.5f);
        ray_ = scene_.camera().sample_ray(film, Vec2(0.5f));
        screenspace::peel(scene_, ray_, layers_, hits_);
        walk_.rays.closest += std::uint64_t(layers_);
        if (!scene_.has_media()) return;
        state_ = scene_.eye_medium_state(ray_);
        scene_.boundaries_along(ray_, walk_.boundary_hits);
        ++walk_.rays.boundary;
    }
    /// Side 2 k is behind layer k, and 2 k - 1 before it. Nothing where rounding lost it.
    std::optional<HiddenVertex> vertex(std::uint32_t side) const {
        const std::size_t layer = (side + 1) / 2;
        const bool behind = side % 2 == 0;
        if (hits_.size() <= layer) return std::nullopt;
        HiddenVertex result;
        ScatteringVertex& v = result.vertex;
        v.hit = hits_[layer], v.position = v.hit.position, v.bsdf = v.hit.shape->bsdf.get();
        v.wo = behind ? ray_.direction : -ray_.direction;
        if (!scene_.has_media()) return result;
        result.state = state_;
        const auto cross = [&](const SurfaceHit& hit) {
            result.state.cross(*hit.shape, hit.geometric_normal, ray_.direction);
        };
        std::size_t b = 0;
        for (std::size_t k = 0; k <= layer; ++k) {
            for (; b < walk_.boundary_hits.size() && walk_.boundary_hits[b].t < hits_[k].t; ++b)
                cross(walk_.boundary_hits[b]);
            if (k < layer || behind) cross(hits_[k]);
        }
        return result;
    }

  private:
    const Scene& scene_;
    int layers_;
    WalkContext& walk_;
    std::uint32_t pixel_ = ~std::uint32_t(0);
    Ray ray_;
    MediumState state_;  ///< where the ray begins
    std::vector<SurfaceHit> hits_;
};

}  // namespace

HiddenLight::HiddenLight(const Scene& scene, const RenderOptions& options,
                         const ScreenSpaceSettings& settings, int max_depth, float bound)
    : scene_(scene),
      options_(options),
      layers_(settings.layers),
      max_depth_(max_depth),
      share_(std::uint32_t(settings.vpl_share)),
      bound_(bound) {
    if (!any()) return;
    screenspace::SsbcSettings ssbc = settings.ssbc;
    ssbc.bound = bound;
    const auto buffers =
        screenspace::make_g_buffers(scene, scene.camera(), options.width, options.height, layers_);
    const auto sides = screenspace::hidden_sides(buffers);
    const auto matter = screenspace::sides_that_matter(screenspace::ssbc_surfaces(buffers[0]), sides, ssbc);
    for (const auto& side : sides)
        for (const float area : side.area) candidates_ += area > 0.0f;
    const auto pixels =
        screenspace::cells_along_z_curve(options.width, options.height, [](int, int) { return true; });
    for (const std::uint32_t pixel : pixels)
        for (std::uint32_t side = 0; side < sides.size(); ++side)
            if (matter[side][pixel]) points_.push_back({pixel, side});
}

bool HiddenLight::pass(const PassContext& context, const lights::VplSet& vpls, std::size_t first_layer,
                       PassImage& image) {
    if (!any() || (max_depth_ >= 0 && max_depth_ < 2)) return !context.cancelled;
    const auto some = [&](int begin, int, int end, int) {
        const auto points = std::span(points_).subspan(std::size_t(begin), std::size_t(end - begin));
        if (scene_.has_media())
            gather<true>(context, vpls, first_layer, points, image);
        else
            gather<false>(context, vpls, first_layer, points, image);
    };
    return for_each_tile(int(points_.size()), 1, 8 * width, context.cancelled, some);
}

template <bool Media>
void HiddenLight::gather(const PassContext& context, const lights::VplSet& vpls, std::size_t first_layer,
                         std::span<const Point> points, PassImage& image) {
    const double begin = thread_cpu_seconds();
    const std::int32_t vpl_depth = max_depth_ < 0 ? std::numeric_limits<std::int32_t>::max() : max_depth_ - 2;
    WalkContext walk, boundaries;  // the latter keeps those of the pixel's ray
    walk.cancelled = boundaries.cancelled = context.cancelled;
    const auto scratch = std::make_unique<lights::GatherScratch>();
    const auto tile = std::make_unique<lights::ReceiverTile>();
    PixelRay along(scene_, layers_, boundaries);
    std::array<HiddenVertex, width> vertices;
    for (; !points.empty(); points = points.subspan(std::min(points.size(), std::size_t(width)))) {
        if (context.cancelled) return;
        const std::size_t count = std::min(points.size(), std::size_t(width));
        std::array<Rgb, width> light{};
        tile->clear();
        // Neighbouring tiles begin with different VPLs, at random, since VPLs follow each other along paths.
        const std::uint64_t key =
            hash_keys(options_.seed, context.index, points[0].pixel, first_stream + points[0].side);
        const lights::VplRange some{key % share_, share_};
        for (std::size_t i = 0; i < count; ++i) {
            const Point& p = points[i];
            along.aim(p.pixel, options_.width);
            const auto found = along.vertex(p.side);
            if (!found || !found->vertex.connectable()) continue;
            vertices[i] = *found;
            Sampler sampler(options_.sampler, options_.seed, context.index, p.pixel, first_stream + p.side);
            walk.rng = sampler.make_rng();
            PathWeights weights;
            if constexpr (Media) weights.hero = sample_hero(walk.rng);
            light[i] =
                scattered_light<Media>(scene_, vertices[i].vertex, weights, vertices[i].state, sampler, walk);
            tile->set(int(i), vertices[i].vertex, Rgb(1.0f), vertices[i].state, Rng(walk.rng.next_u32()),
                      vpl_depth);
        }
        const auto indirect = lights::gather({scene_, *scratch, walk.rays, walk.tracking, walk.cancelled},
                                             vpls, some, lights::BoundedGeometry{bound_}, *tile);
        for (std::size_t i = 0; i < count; ++i)
            image.layer(first_layer + points[i].side)[points[i].pixel] =
                light[i] + float(share_) * indirect[i];
    }
    counters_.add(walk.rays, walk.tracking), counters_.add(boundaries.rays, boundaries.tracking);
    const std::lock_guard lock(mutex_);
    seconds_ += thread_cpu_seconds() - begin;
}

void HiddenLight::add_statistics(Statistics& statistics) const {
    if (!any()) return;
    statistics.values["hidden_points"] = double(points_.size());
    statistics.values["hidden_points_without_effect"] = double(candidates_ - points_.size());
    statistics.values["hidden_thread_seconds"] += seconds_;
    counters_.report(statistics, scene_.has_media());
}

}  // namespace mote::integrators
