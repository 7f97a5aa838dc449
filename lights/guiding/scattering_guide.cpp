#include "lights/guiding/scattering_guide.h"

#include <algorithm>

namespace mote::lights {

using namespace core;

namespace {

class NoGuide final : public ScatteringGuide {
  public:
    void find(const ScatteringVertex&, VmfMixture& lobes) const override { lobes.empty = true; }
};

GuidedSample weighted(ScatterSample s, const Rgb& f_cos, float own_pdf, float pdf) {
    s.weight = f_cos / pdf, s.pdf_solid_angle = pdf;
    return {s, std::min(pdf / own_pdf, max_pdf_ratio)};
}

}  // namespace

const ScatteringGuide& no_guide() {
    static const NoGuide none;
    return none;
}

std::optional<GuidedSample> sample_guided(const ScatteringVertex& vertex, const VmfMixture& lobes,
                                          float u_lobe, const Vec2& u, TransportMode mode) {
    if (lobes.empty) {
        const auto own = vertex.sample(u_lobe, u, mode);
        return own ? std::optional(GuidedSample{*own}) : std::nullopt;
    }
    if (u_lobe >= guide_probability) {
        const float rest =
            std::min((u_lobe - guide_probability) / (1.0f - guide_probability), one_minus_epsilon);
        const auto own = vertex.sample(rest, u, mode);
        if (!own) return std::nullopt;
        const float pdf = guided_pdf(lobes, own->wi, own->pdf_solid_angle);
        return weighted(*own, own->weight * own->pdf_solid_angle, own->pdf_solid_angle, pdf);
    }
    ScatterSample guided{};
    guided.wi = lobes.sample(u_lobe / guide_probability, u);
    const ScatteringValue f = vertex.eval_cos_and_pdf(guided.wi, mode);
    if (is_black(f.f_cos)) return std::nullopt;
    return weighted(guided, f.f_cos, f.pdf_solid_angle, guided_pdf(lobes, guided.wi, f.pdf_solid_angle));
}

}  // namespace mote::lights
