#include "lights/guiding/learned_guide.h"

#include <algorithm>

namespace mote::lights {

using namespace core;

namespace {

/// Share of the memory that goes to reflected radiance, and samples of its leaves over those of mixtures: a
/// few moments need fewer.
constexpr double reflected_share = 0.25, reflected_samples = 1.0 / 40.0, min_reflected_samples = 128.0;

/// Shares of the memory for each field of directions and of reflected radiance. With media they and surfaces
/// have half of it each, and a share of that is for reflected radiance where vertices are chosen. Surfaces
/// alone have all of it for directions.
struct Shares {
    double surfaces = 1.0, media = 0.0, reflected = 0.0;
};
Shares shares_of(bool media, GuideParts largest) {
    if (!media) return {};
    const double reflected = largest == GuideParts::directions_and_vertices ? 0.5 * reflected_share : 0.0;
    return {0.5 - reflected, 0.5 - reflected, reflected};
}
GuidingField::Settings with_share(const GuidingField::Settings& s, double share) {
    return {s.leaf_samples, s.bytes * share};
}
ReflectedField reflected_field(const GuidingField::Settings& s, double share, const MemoryBudget& memory) {
    return {std::max(min_reflected_samples, reflected_samples * s.leaf_samples), s.bytes * share, memory};
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

LearnedGuide::LearnedGuide(const GuidingField::Settings& settings, bool media, GuideParts largest,
                           const MemoryBudget& memory)
    : surfaces_(with_share(settings, shares_of(media, largest).surfaces), memory),
      media_(with_share(settings, shares_of(media, largest).media), memory),
      reflected_by_surfaces_(reflected_field(settings, shares_of(media, largest).reflected, memory)),
      reflected_by_media_(reflected_field(settings, shares_of(media, largest).reflected, memory)),
      parts_(largest) {}

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
