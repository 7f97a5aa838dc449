// <phase type="hg">: Henyey-Greenstein scattering with mean cosine g (Henyey & Greenstein 1941).
//
// wo and wi both point away from the point, so light that keeps its direction has wi = -wo: for g > 0 the
// preferred direction is -wo, for g < 0 it is wo.
#include "core/math/frame.h"
#include "core/parameters/add_type.h"
#include "media/henyey_greenstein.h"
#include "media/phase_functions.h"

namespace mote::media {

using core::Rgb, core::Vec2, core::Vec3;

HenyeyGreensteinPhase::HenyeyGreensteinPhase(float g) : g_(g) {
    if (!(std::fabs(g) < 1.0f))
        throw core::InputError("'g' is " + std::to_string(g) +
                               ": Henyey-Greenstein needs a mean cosine between -1 and 1, both excluded");
}

float HenyeyGreensteinPhase::pdf_solid_angle(const Vec3& wo, const Vec3& wi) const {
    const Vec3 difference = g_ >= 0.0f ? wi + wo : wi - wo;  // wi minus the preferred direction
    const float h = 0.5f * glm::dot(difference, difference);
    return media::henyey_greenstein(std::fabs(g_), h);
}

Rgb HenyeyGreensteinPhase::eval(const Vec3& wo, const Vec3& wi) const { return Rgb(pdf_solid_angle(wo, wi)); }

core::PhaseSample HenyeyGreensteinPhase::sample(const Vec3& wo, const Vec2& u) const {
    const float h = sample_henyey_greenstein(std::fabs(g_), u.x);
    const float sin_theta = core::safe_sqrt(h * (2.0f - h)), phi = 2.0f * core::pi * u.y;
    const core::Frame frame(g_ >= 0.0f ? -wo : wo);
    const Vec3 wi = frame.to_world({sin_theta * std::cos(phi), sin_theta * std::sin(phi), 1.0f - h});
    return {wi, Rgb(1.0f), pdf_solid_angle(wo, wi)};
}

void register_hg_phase(core::Registry& registry) {
    using namespace core;
    struct Settings {
        float g = 0.8f;
    };
    add_type<Settings>(registry, Category::phase, "hg",
                       "Henyey-Greenstein: prefers one direction, forward for g > 0 and backward for g < 0.",
                       {row("g", &Settings::g, inside(-1, 1), "Mean cosine of the scattering angle.")},
                       R"(<phase type="hg"><float name="g" value="0.8"/></phase>)",
                       [](const Settings& s) { return std::make_shared<HenyeyGreensteinPhase>(s.g); });
}

}  // namespace mote::media
