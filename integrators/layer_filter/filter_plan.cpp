#include "integrators/layer_filter/filter_plan.h"

#include <algorithm>

namespace mote::integrators {

using namespace core;

namespace {

/// For each run of the denoiser saved, below which layers of a kind are denoised as one. A run takes as long
/// as some 3 to 60, by scene and processor; one for each layer lowers the error by 1 to 16 %. At this work it
/// is worth its time in five scenes of six (smoke room: from 50 on).
constexpr double work_of_layer = 15.0;

/// Below which features are rough: the error is larger by 12 to 20 %, but to march and denoise the others
/// takes as long as 40 (city) to more than 90 (smoke room, Cornell box).
constexpr double work_of_features = 90.0;

/// From which on quarters of pixels are denoised. Their features and runs take as long as twelve runs, and
/// lower the error by up to a sixth at 640 x 400, by up to a quarter at half that size.
constexpr double work_of_fine = 300.0;
/// With fewer, noise of quarters costs what their detail gains; and with a few, many have no sample, and
/// OpenImageDenoise takes what fills them for detail.
constexpr std::uint32_t passes_of_fine = 32;

double work_of_pixel(const Film& film, std::uint32_t more) {
    double work = 0.0;
    for (std::size_t part = 0; part < film.parts(); ++part) work += film.work(part);
    const double passes = std::max(film.pass_count(), 1u);
    return work * (1.0 + more / passes) / double(film.pixels());
}

}  // namespace

std::uint32_t passes_of(const Film& film, std::size_t layer) {
    return film.pass_count(film.layers()[layer].part);
}

std::vector<LayersOfKind> kinds_of(const Film& film, std::span<const ChosenLayer> layers) {
    std::vector<LayersOfKind> result;
    // Light that is scattered once shows shafts and has little noise; the noise of the rest would hide them:
    // as one they have 1.4 times the squared error (fog, 4 passes).
    const auto group_of = [&](const ChosenLayer& chosen) {
        if (chosen.kind == screenspace::LayerKind::surface) return 0;
        return film.layers()[chosen.layer].transport == Transport::multiple_scattering ? 2 : 1;
    };
    for (const int group : {0, 1, 2}) {
        LayersOfKind found{group == 0 ? screenspace::LayerKind::surface : screenspace::LayerKind::volume, {}};
        for (const ChosenLayer& chosen : layers)
            if (group_of(chosen) == group && passes_of(film, chosen.layer) > 0)
                found.layers.push_back(chosen.layer);
        if (!found.layers.empty()) result.push_back(std::move(found));
    }
    return result;
}

bool FilterPlan::is_fine(std::size_t layer) const { return std::ranges::find(fine, layer) != fine.end(); }

FilterPlan plan_filter(const Film& film, std::span<const ChosenLayer> layers, std::uint32_t more) {
    const double work = work_of_pixel(film, more);
    const std::size_t saved = layers.size() - kinds_of(film, layers).size();
    FilterPlan plan{.joins = work < work_of_layer * double(saved), .full_features = work >= work_of_features};
    if (plan.joins || work < work_of_fine) return plan;
    for (const auto& [layer, kind] : layers)
        if (passes_of(film, layer) + more >= passes_of_fine && film.fine_sums(layer).has_light())
            plan.fine.push_back(layer);
    return plan;
}

}  // namespace mote::integrators
