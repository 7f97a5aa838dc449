#include "lights/ray_lights/ray_light.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace mote::lights {

using namespace core;

namespace {

constexpr std::uint32_t chunk_size = 32, chunks_at_once = 1024;
constexpr std::uint32_t ray_light_stream = 0x56524cu;  // apart from pixels of the same index

/// Leaves ray lights on the segments of one path, and VPLs on surfaces.
template <bool Media>
void leave_lights(const LitScene& scene, const ScatteringMedia& media, const LightPathSettings& settings,
                  std::uint32_t path, Sampler& sampler, WalkContext& context, RayLightSet& set) {
    const auto leave_vpl = [&](const ScatteringVertex& vertex, const Rgb& alpha, int depth,
                               const MediumState&) {
        if (vertex.on_surface()) append_vpl(set.surface, vertex, alpha, std::uint32_t(depth), path);
    };
    // Lines have a generator of their own, apart from the path's.
    Rng rng(context.rng.next_u32());
    const auto leave_rays = [&](const Ray& ray, const MediumState& state, const PathWeights& weights,
                                const WalkEvent& event, int depth) {
        if constexpr (Media) {
            const Rgb power = weights.throughput / average(weights.unidirectional);
            for_each_medium_line(
                {ray, event.surface_distance, state, context.boundary_hits}, media, rng, context.tracking,
                [&](const MediumLine& line, const MediumState&, const Rgb& transmittance) {
                    set.rays.push_back({line, power * transmittance, std::uint32_t(depth), path});
                });
        }
    };
    follow_light_path<Media>(scene, settings, sampler, context, leave_vpl, AnyStart{}, leave_rays);
}

RayLightSet trace_chunk(const LitScene& scene, const ScatteringMedia& media,
                        const LightPathSettings& settings, std::uint32_t begin, std::uint32_t end,
                        std::uint64_t seed, std::uint32_t pass, SamplerKind kind, CancelToken cancelled) {
    RayLightSet set;
    for (std::uint32_t path = begin; path < end; ++path) {
        Sampler sampler(kind, seed, path, pass, ray_light_stream);
        WalkContext context;
        context.cancelled = cancelled;
        context.rng = Rng(hash_keys(seed, pass, path, ray_light_stream));
        if (scene.has_media())
            leave_lights<true>(scene, media, settings, path, sampler, context, set);
        else
            leave_lights<false>(scene, media, settings, path, sampler, context, set);
        set.surface.rays.add(context.rays);
        set.surface.tracking.add(context.tracking);
    }
    return set;
}

void append(RayLightSet& to, RayLightSet&& from) {
    VplSet& vpls = to.surface;
    const auto offset = std::uint32_t(vpls.details.size());
    for (VirtualPointLight& vpl : from.surface.lights)
        if (vpl.detail != VirtualPointLight::no_detail) vpl.detail += offset;
    vpls.lights.insert(vpls.lights.end(), from.surface.lights.begin(), from.surface.lights.end());
    vpls.details.insert(vpls.details.end(), from.surface.details.begin(), from.surface.details.end());
    vpls.rays.add(from.surface.rays), vpls.tracking.add(from.surface.tracking);
    to.rays.insert(to.rays.end(), from.rays.begin(), from.rays.end());
}

/// Light scattered on the line, by its weights, over the root of its length. For a line of length L and power
/// P that is P sqrt(L), which is how its light spreads: P / d within L of it, P L / d^2 farther away, so that
/// the mean of the square over receivers on surfaces around it is P^2 L, but for logarithms. Sampled by P L,
/// short lines would count so much where they are sampled that they were points again. Lines below
/// `shortest` count as if they had that length: few receivers are as near, and lines of nanometres, as in
/// media of 1e9 optical depths a metre, would take all samples.
double sampling_power(const RayLight& light, double shortest) {
    double sum = 0.0;
    for (const float weight : light.line.cell_weights()) sum += double(weight);
    const double length = double(light.line.length);
    return double(average(light.power)) * sum * length / double(light.line.cells) /
           std::sqrt(std::max(length, shortest));
}

/// Length below which lines count as if they had it [m].
double shortest_length(const std::vector<RayLight>& rays) {
    constexpr float of_longest = 1e-3f;
    float longest = 0.0f;
    for (const RayLight& light : rays) longest = std::max(longest, light.line.length);
    return double(of_longest * longest);
}

/// Power of a VPL, about: its intensity holds the BSDF where that is a constant.
double reflected_power(const VirtualPointLight& vpl) {
    const double constant = vpl.detail == VirtualPointLight::no_detail ? 1.0 : double(inv_pi);
    return constant * double(average(vpl.intensity));
}

}  // namespace

RayLightSet trace_ray_lights(const LitScene& scene, const ScatteringMedia& media,
                             const LightPathSettings& settings, std::uint64_t seed, std::uint32_t pass,
                             SamplerKind sampler, CancelToken cancelled) {
    const std::uint32_t chunks = (settings.paths + chunk_size - 1) / chunk_size;
    RayLightSet set;
    for (std::uint32_t first = 0; first < chunks; first += chunks_at_once) {
        std::vector<RayLightSet> parts(std::min(chunks_at_once, chunks - first));
        tbb::parallel_for(std::size_t(0), parts.size(), [&](std::size_t p) {
            const std::uint32_t begin = (first + std::uint32_t(p)) * chunk_size;
            const std::uint32_t end = std::min(begin + chunk_size, settings.paths);
            parts[p] = trace_chunk(scene, media, settings, begin, end, seed, pass, sampler, cancelled);
        });
        for (RayLightSet& part : parts) append(set, std::move(part)), part = {};
        if (first == 0 && parts.size() < chunks)  // lists that grow by doubling hold it twice
            settings.memory.require(2.0 * double(chunks) / double(parts.size()) * double(set.memory_bytes()),
                                    "the ray lights of " + std::to_string(settings.paths) + " light paths");
    }
    set.surface.paths = settings.paths;
    const double shortest = shortest_length(set.rays);
    double sum = 0.0;
    for (const RayLight& light : set.rays) set.ray_power.push_back(sum += sampling_power(light, shortest));
    sum = 0.0;
    for (const VirtualPointLight& vpl : set.surface.lights)
        set.surface_power.push_back(sum += reflected_power(vpl));
    return set;
}

WeightedVpl PowerSampling::choose(std::size_t n, float start) const { return choose_behind(n, start, 0); }

/// Searches from `first` on.
WeightedVpl PowerSampling::choose_behind(std::size_t n, float start, std::size_t first) const {
    if (all_) return {n, 1.0f};
    const double total = power_.back(), target = (double(n) + double(start)) / double(count_) * total;
    std::size_t index = first;
    constexpr std::size_t few = 8;  // steps of a walk are foreseen, those of a search are not
    for (std::size_t i = 0; i < few && index < power_.size() && power_[index] <= target; ++i) ++index;
    if (index < power_.size() && power_[index] <= target)
        index = std::size_t(std::upper_bound(power_.begin() + std::ptrdiff_t(index), power_.end(), target) -
                            power_.begin());
    index = std::min(index, power_.size() - 1);
    const double own = power_[index] - (index > 0 ? power_[index - 1] : 0.0);
    return {index, own > 0.0 ? float(total / (own * double(count_))) : 0.0f};
}

void PowerSampling::choose_all(float start, std::vector<WeightedVpl>& lights) const {
    lights.clear();
    for (std::size_t n = 0; n < count(); ++n)
        lights.push_back(choose_behind(n, start, n == 0 ? 0 : lights.back().index));
}

}  // namespace mote::lights
