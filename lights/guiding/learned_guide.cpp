#include "lights/guiding/learned_guide.h"

#include <algorithm>

namespace mote::lights {

using namespace core;

namespace {

/// Share of the memory that goes to reflected radiance, and samples of its leaves over those of mixtures: a
/// few moments need fewer.
constexpr double reflected_share = 0.25, reflected_samples = 1.0 / 40.0, min_reflected_samples = 128.0;

/// With media they and surfaces have half of the memory each, and a share of it is for reflected radiance.
/// Surfaces alone have all of it for directions.
GuidingField::Settings field_settings(const GuidingField::Settings& s, bool media, bool for_media) {
    const double share = media ? 0.5 * (1.0 - reflected_share) : for_media ? 0.0 : 1.0;
    return {s.leaf_samples, s.bytes * share};
}
ReflectedField reflected_field(const GuidingField::Settings& s, bool media, const MemoryBudget& memory) {
    return {std::max(min_reflected_samples, reflected_samples * s.leaf_samples),
            media ? s.bytes * 0.5 * reflected_share : 0.0, memory};
}

template <typename Sample>
void append_to(std::vector<Sample>& to, const std::vector<Sample>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

void GuidingSamples::append(const GuidingSamples& o) {
    append_to(surfaces, o.surfaces), append_to(media, o.media);
    append_to(reflected_by_surfaces, o.reflected_by_surfaces);
    append_to(reflected_by_media, o.reflected_by_media);
}

LearnedGuide::LearnedGuide(const GuidingField::Settings& settings, bool media, const MemoryBudget& memory)
    : surfaces_(field_settings(settings, media, false), memory),
      media_(field_settings(settings, media, true), memory),
      reflected_by_surfaces_(reflected_field(settings, media, memory)),
      reflected_by_media_(reflected_field(settings, media, memory)) {}

void LearnedGuide::add(GuidingSamples& samples) {
    surfaces_.add(samples.surfaces), media_.add(samples.media);
    reflected_by_surfaces_.add(samples.reflected_by_surfaces);
    reflected_by_media_.add(samples.reflected_by_media);
}

void LearnedGuide::scale(double factor) {
    surfaces_.scale(factor), media_.scale(factor);
    reflected_by_surfaces_.scale(factor), reflected_by_media_.scale(factor);
}

std::size_t LearnedGuide::leaves() const {
    return surfaces_.leaves().size() + media_.leaves().size() + reflected_by_surfaces_.leaves().size() +
           reflected_by_media_.leaves().size();
}

ExpectedRadiance LearnedGuide::expected(const Vec3& position, bool on_surface) const {
    if (!chooses()) return {};
    return (on_surface ? reflected_by_surfaces_ : reflected_by_media_).at(position);
}

bool LearnedGuide::guides(const ScatteringVertex& vertex) {
    if (!vertex.on_surface()) return true;
    const BsdfTraits traits = vertex.bsdf->traits();
    return traits.smooth && !traits.delta && !traits.transmissive && !traits.passes_straight();
}

void LearnedGuide::find(const ScatteringVertex& vertex, VmfMixture& lobes) const {
    lobes.empty = true;
    if (!guides(vertex)) return;
    lobes = (vertex.on_surface() ? surfaces_ : media_).at(vertex.position);
    if (lobes.empty) return;
    if (!vertex.on_surface()) return lobes.multiply(phase_lobe(vertex.wo, vertex.phase->mean_cosine()));
    const Vec3& n = vertex.hit.shading.n;
    lobes.multiply(cosine_lobe(glm::dot(n, vertex.wo) < 0.0f ? -n : n));
}

}  // namespace mote::lights
