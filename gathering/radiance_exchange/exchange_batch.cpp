#include "gathering/radiance_exchange/exchange_batch.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <numeric>

namespace mote::gathering {

using namespace core;

ExchangeBatch::ExchangeBatch(const ExchangeScene& scene, float spacing, std::uint32_t directions, bool lights)
    : scene_(scene), spacing_(spacing), count_(directions), lights_(lights), directions_(directions) {
    const std::size_t n = scene.atlas.size();
    from_surface_.resize(directions, Rgb4Vector(n));
    if (!lights) return;
    from_light_.resize(directions, Rgb4Vector(n));
    emitted_.resize(n);
    for (std::size_t t = 0; t < n; ++t) {
        const Rgb& e = scene.materials.of[t].emission;
        emitted_[t] = rgb4(e, is_black(e) ? 0.0f : 1.0f);
    }
}

void ExchangeBatch::run(const BatchDirections& directions, std::uint32_t first, const Sent& sent,
                        CancelToken cancelled) {
    const SurfaceAtlas& atlas = scene_.atlas;
    const std::size_t glossy = scene_.materials.glossy.size();
    std::vector<std::uint64_t> hits(count_), met(count_);
    tbb::parallel_for(std::uint32_t(0), count_, [&](std::uint32_t i) {
        const BundleSample sample = directions.at(first + i);
        const Vec3 d = directions_[i] = sample.direction;
        const BundleGrid grid = bundle_grid(d, atlas.surfaces().bounds, spacing_, sample.offset);
        BundleSettings settings;
        settings.cancelled = cancelled;
        // A thread that waits within must not begin another direction, whose bundle would come on top.
        const RayBundle bundle =
            tbb::this_task_arena::isolate([&] { return scene_.tracer.trace(grid, settings); });
        std::fill(from_surface_[i].begin(), from_surface_[i].end(), Rgb4{});
        SentRadiance s{sent.reflected.data(), sent.glossy.data() + i * glossy, nullptr};
        ReceivedRadiance r{from_surface_[i].data(), nullptr};
        if (lights_) {
            std::fill(from_light_[i].begin(), from_light_[i].end(), Rgb4{});
            s.emitted = emitted_.data(), r.emitted = from_light_[i].data();
            if (scene_.environment)
                s.from_ahead = scene_.environment->environment(d),
                s.from_behind = scene_.environment->environment(-d);
        }
        met[i] = exchange_radiance(atlas, bundle, s, r);
        hits[i] = bundle.hits.size();
    });
    for (const std::uint64_t h : hits) hits_ += h;
    find_scale(double(std::accumulate(met.begin(), met.end(), std::uint64_t(0))));
}

void ExchangeBatch::find_scale(double met) {
    double area = 0.0;
    for (const AtlasTexel& t : scene_.atlas.texels()) area += double(t.area);
    const double uniform = 2.0 * double(sqr(spacing_)) * met / double(count_);  // times pi, as the area below
    scale_ = uniform > 0.0 ? float(area / uniform) : 1.0f;
}

float ExchangeBatch::weight(std::uint32_t i, const AtlasTexel& texel) const {
    const float w = 2.0f * pi * sqr(spacing_) * scale_ / texel.area;
    if (texel.normal == texel.geometric_normal) return w;
    const Vec3& d = directions_[i];
    const float geometric = glm::dot(texel.geometric_normal, d);
    // Rays there are by the geometric cosine; what they bring counts by the shading one, on the same side.
    const float shading = glm::dot(texel.normal, geometric < 0.0f ? -d : d);
    return w * std::fmax(shading, 0.0f) / std::fmax(std::fabs(geometric), 1e-3f);
}

TexelIrradiance ExchangeBatch::mean() const {
    const auto texels = scene_.atlas.texels();
    TexelIrradiance result;
    result.reflected.resize(texels.size());
    if (lights_) result.emitted.resize(texels.size());
    tbb::parallel_for(std::size_t(0), texels.size(), [&](std::size_t t) {
        for (std::uint32_t i = 0; i < count_; ++i) {
            const float w = weight(i, texels[t]) / float(count_);
            result.reflected[t] += w * from_surface_[i][t].rgb();
            if (lights_) result.emitted[t] += w * from_light_[i][t].rgb();
        }
    });
    return result;
}

Rgb ExchangeBatch::irradiance(std::uint32_t i, std::uint32_t texel) const {
    Rgb sum = from_surface_[i][texel].rgb();
    if (lights_) sum += from_light_[i][texel].rgb();
    return weight(i, scene_.atlas.texels()[texel]) * sum;
}

Vec3 ExchangeBatch::direction_above(std::uint32_t i, std::uint32_t texel) const {
    const Vec3& d = directions_[i];
    return glm::dot(scene_.atlas.texels()[texel].geometric_normal, d) < 0.0f ? -d : d;
}

std::size_t ExchangeBatch::memory_bytes() const {
    return (from_surface_.size() + from_light_.size() + 1) * scene_.atlas.size() * sizeof(Rgb4);
}

}  // namespace mote::gathering
