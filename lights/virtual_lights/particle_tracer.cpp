#include "lights/virtual_lights/particle_tracer.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <string>

namespace mote::lights {

using namespace core;

namespace {

constexpr std::uint32_t chunk_size = 32;
/// Traced side by side before they are put together: what a million lights take twice is little of them.
constexpr std::uint32_t chunks_at_once = 1024;
constexpr std::uint32_t light_path_stream =
    0x56504cu;  // keeps light paths apart from pixels of the same index

template <bool Media, typename Visit, typename Start>
void follow(const LitScene& scene, const LightPathSettings& settings, const LightPathStarts* starts,
            std::uint32_t path, Sampler& sampler, WalkContext& context, const Visit& visit,
            const Start& on_start) {
    if (!starts) return follow_light_path<Media>(scene, settings, sampler, context, visit, on_start);
    if (const auto begin = starts->start(path, sampler))
        follow_particle<Media>(scene, settings, *begin->emitter, begin->emission, begin->power, sampler,
                               context, visit);
}

VplSet trace_chunk(const LitScene& scene, const LightPathSettings& settings, std::uint32_t begin,
                   std::uint32_t end, std::uint64_t seed, std::uint32_t pass, SamplerKind kind,
                   CancelToken cancelled, const LightPathStarts* starts) {
    VplSet set;
    if (settings.keep_starts) set.starts.resize(end - begin);
    for (std::uint32_t path = begin; path < end; ++path) {
        // The paths of one pass form one low-discrepancy set; every pass has a scramble of its own.
        Sampler sampler(kind, seed, path, pass, light_path_stream);
        WalkContext context;
        context.cancelled = cancelled;
        context.rng = Rng(hash_keys(seed, pass, path, light_path_stream));
        const auto keep_start = [&](const LightChoice& choice, const EmissionSample& emission) {
            if (settings.keep_starts)
                set.starts[path - begin] = {choice.emitter, emission.origin, emission.normal,
                                            emission.direction};
        };
        const auto leave_vpl = [&](const ScatteringVertex& vertex, const Rgb& alpha, int depth,
                                   const MediumState& state) {
            append_vpl(set, vertex, alpha, std::uint32_t(depth), path);
            if (settings.keep_states && scene.has_media() && set.states.size() < set.lights.size())
                set.states.push_back(state);
        };
        if (scene.has_media())
            follow<true>(scene, settings, starts, path, sampler, context, leave_vpl, keep_start);
        else
            follow<false>(scene, settings, starts, path, sampler, context, leave_vpl, keep_start);
        set.rays.add(context.rays);
        set.tracking.add(context.tracking);
    }
    return set;
}

void append(VplSet& to, VplSet&& from) {
    const auto offset = std::uint32_t(to.details.size());
    for (VirtualPointLight& vpl : from.lights)
        if (vpl.detail != VirtualPointLight::no_detail) vpl.detail += offset;
    to.lights.insert(to.lights.end(), from.lights.begin(), from.lights.end());
    to.details.insert(to.details.end(), from.details.begin(), from.details.end());
    to.states.insert(to.states.end(), from.states.begin(), from.states.end());
    to.starts.insert(to.starts.end(), from.starts.begin(), from.starts.end());
    to.rays.add(from.rays);
    to.tracking.add(from.tracking);
}

/// For so many times as much and a little more: lists that grow by doubling would hold it twice.
void reserve(VplSet& set, double times) {
    const auto reserve_list = [&](auto& list) {
        list.reserve(std::size_t(1.05 * times * double(list.size())));
    };
    reserve_list(set.lights), reserve_list(set.details), reserve_list(set.states), reserve_list(set.starts);
}

}  // namespace

VplSet trace_light_paths(const LitScene& scene, const LightPathSettings& settings, std::uint64_t seed,
                         std::uint32_t pass, SamplerKind sampler, CancelToken cancelled,
                         const LightPathStarts* starts) {
    const std::uint32_t chunks = (settings.paths + chunk_size - 1) / chunk_size;
    VplSet set;
    for (std::uint32_t first = 0; first < chunks; first += chunks_at_once) {
        std::vector<VplSet> parts(std::min(chunks_at_once, chunks - first));
        tbb::parallel_for(std::size_t(0), parts.size(), [&](std::size_t p) {
            const std::uint32_t begin = (first + std::uint32_t(p)) * chunk_size;
            const std::uint32_t end = std::min(begin + chunk_size, settings.paths);
            parts[p] = trace_chunk(scene, settings, begin, end, seed, pass, sampler, cancelled, starts);
        });
        for (VplSet& part : parts) append(set, std::move(part)), part = {};
        if (first > 0 || parts.size() == chunks) continue;
        const double times = double(chunks) / double(parts.size());
        settings.memory.require(
            times * double(set.memory_bytes()),
            "the virtual point lights of " + std::to_string(settings.paths) + " light paths",
            [&](double available) {
                const double paths = available / (times * double(set.memory_bytes())) * settings.paths;
                return "those of about " + std::to_string(std::uint32_t(paths)) + " fit";
            });
        reserve(set, times);
    }
    set.paths = settings.paths;
    return set;
}

}  // namespace mote::lights
