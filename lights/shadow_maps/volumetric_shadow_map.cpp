// Sizes and building; shadow_map_builder.cpp fills a texel, shadow_map_lookup.cpp reads them.
#include "lights/shadow_maps/volumetric_shadow_map.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>

#include "core/objects/error.h"
#include "lights/shadow_maps/shadow_map_builder.h"

namespace mote::lights {

using namespace core;

std::size_t ShadowMapSettings::bytes(int size, bool chromatic) const {
    const std::size_t record =
        sizeof(VolumetricShadowMap::Header) + values() * (chromatic ? 3 : 1) * sizeof(std::uint16_t);
    return std::size_t(size + 2) * std::size_t(size + 2) * ((record + 31) / 32 * 32);
}

void ShadowMapSettings::check(int size, bool chromatic) const {
    if (intervals < 1 || size < 1 || !(step > 0.0f))
        throw InputError("a volumetric shadow map needs at least one texel, one interval and a step above 0");
    if (bytes(size, chromatic) <= max_bytes) return;
    const double texel = double(bytes(1, chromatic)) / 9.0;
    const int fits = int(std::sqrt(double(max_bytes) / texel)) - 2;
    throw InputError(fmt::format(
        "a volumetric shadow map of {0} x {0} texels takes {1:.2f} MB, above the limit of {2:.2f} MB; {3}",
        size, double(bytes(size, chromatic)) * 1e-6, double(max_bytes) * 1e-6,
        fits > 0 ? fmt::format("{0} x {0} would fit", fits) : "not even one texel would fit"));
}

bool needs_chromatic_maps(const RayQueries& scene) {
    if (scene.has_coloured_panes()) return true;
    const auto media = scene.media();
    return std::any_of(media.begin(), media.end(), [](const auto& m) { return m->traits().chromatic; });
}

void require_shadow_maps(const MemoryBudget& memory, const ShadowMapSettings& settings, std::size_t maps,
                         int size, bool chromatic) {
    const double bytes = double(maps) * double(settings.bytes(size, chromatic));
    memory.require(bytes, fmt::format("{} shadow map(s) of {}^2 texels", maps, size), [&](double available) {
        return fmt::format("maps of {}^2 fit",
                           std::max(0, int(std::sqrt(available / bytes) * (size + 2)) - 2));
    });
}

void VolumetricShadowMap::build(const RayQueries& scene, const ShadowMapView& view,
                                const MediumState& at_light, const ShadowMapSettings& settings,
                                CancelToken cancelled) {
    const bool chromatic = needs_chromatic_maps(scene);
    settings.check(view.size, chromatic);
    view_ = view, settings_ = settings, channels_ = chromatic ? 3 : 1;
    const std::size_t row = std::size_t(view.size) + 2, bytes = settings.bytes(view.size, chromatic);
    blocks_ = bytes / (row * row * sizeof(Block));
    records_.resize(row * row * blocks_);
    tbb::enumerable_thread_specific<ShadowMapBuilder> builders(
        [&] { return ShadowMapBuilder(scene, *this, at_light); });
    tbb::parallel_for(0, view.size, [&](int j) {
        ShadowMapBuilder& builder = builders.local();
        cancelled.check();
        for (int i = 0; i < view.size; ++i)
            builder.fill(j * view.size + i, record(std::size_t(j + 1) * row + std::size_t(i + 1)));
    });
    copy_border();
    rays_ = {};
    for (const ShadowMapBuilder& builder : builders) rays_.add(builder.rays());
}

void VolumetricShadowMap::copy_border() {
    const int size = view_.size, row = size + 2;
    const auto copy = [&](int i, int j) {
        const int from = view_.neighbour(i, j);
        const int inner = (from / size + 1) * row + from % size + 1;
        std::memcpy(record(std::size_t((j + 1) * row + i + 1)), record(std::size_t(inner)),
                    blocks_ * sizeof(Block));
    };
    for (int i = -1; i <= size; ++i) copy(i, -1), copy(i, size);
    for (int j = 0; j < size; ++j) copy(-1, j), copy(size, j);
}

}  // namespace mote::lights
