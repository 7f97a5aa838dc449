#include "lights/guiding/learned_guide.h"

namespace mote::lights {

using namespace core;

namespace {

/// Half of the memory for each of the two fields; a scene without media has one.
GuidingField::Settings field_settings(GuidingField::Settings settings, bool media, bool for_media) {
    settings.bytes *= media ? 0.5 : for_media ? 0.0 : 1.0;
    return settings;
}

}  // namespace

LearnedGuide::LearnedGuide(const GuidingField::Settings& settings, bool media, const MemoryBudget& memory)
    : surfaces_(field_settings(settings, media, false), memory),
      media_(field_settings(settings, media, true), memory) {}

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
