// <medium type="heterogeneous">: the extinction is a volume; that volume builds the medium.
#include "media/heterogeneous_medium.h"

#include "media/phase_functions.h"
#include "media/volume.h"

namespace mote::media {

using core::Rgb;

HeterogeneousMedium::HeterogeneousMedium(MediumParts parts)
    : parts_(std::move(parts)),
      constant_albedo_(parts_.albedo->constant()),
      emissive_(parts_.emission.any() &&
                !(constant_albedo_ && core::min_component(*constant_albedo_) == 1.0f)),
      absorbs_alone_(!emissive_ && core::is_black(parts_.albedo->upper_bound())) {}

Rgb HeterogeneousMedium::albedo_at(const core::Vec3& p) const {
    return constant_albedo_ ? *constant_albedo_ : parts_.albedo->eval(p);
}

std::shared_ptr<core::Emitter> HeterogeneousMedium::make_emitter(const core::Bounds3& box) {
    if (!emissive_ || box.empty()) return nullptr;
    emitter_ = std::make_shared<MediumEmitter>(*this, box, true);
    return emitter_;
}

namespace {

struct HeterogeneousSettings : MediumParts {
    VolumePtr sigma_t = make_constant_volume(1.0f), density;
    HeterogeneousSettings() {
        albedo = make_constant_volume(0.75f), phase = std::make_shared<IsotropicPhase>();
    }
};

const core::ParameterList<HeterogeneousSettings>& heterogeneous_rows() {
    using namespace core;
    using S = HeterogeneousSettings;
    static const ParameterList<S> list{
        row("sigma_t", &S::sigma_t, at_least(0, "1/m"), "Extinction, times `scale`."),
        row("density", &S::density, at_least(0, "1/m"), "Another name for sigma_t (that of version 0.x).")
            .when_absent("none"),
        row("albedo", &S::albedo, between(0, 1), "Single-scattering albedo."),
        row("scale", &S::scale, at_least(0), "Multiplies the extinction."),
        nested("phase", &S::phase, Category::phase, "isotropic", "The phase function."),
        within(&S::emission, emission_rows()),
        within(&S::tracking, tracking_rows())};
    return list;
}

std::shared_ptr<HeterogeneousMedium> make_heterogeneous(HeterogeneousSettings s, const core::Properties& p) {
    if (p.has("sigma_t") && s.density)
        throw core::InputError("'density' is another name for 'sigma_t': give one of them", p.where);
    finish_emission(s.emission, p);
    const float largest_albedo = core::max_component(s.albedo->upper_bound());
    if (largest_albedo > 1.0f)
        throw core::InputError("'albedo' reaches " + std::to_string(largest_albedo) + ", above 1",
                               p.where_of("albedo"));
    auto medium = (s.density ? s.density : s.sigma_t)->make_medium(s);
    if (!std::isfinite(medium->majorant()))
        throw core::InputError("the extinction times 'scale' is too large for a number", p.where);
    if (medium->traits().empty) p.warn("the medium is empty: it is treated as vacuum");
    return medium;
}

}  // namespace

void register_heterogeneous_medium(core::Registry& registry) {
    core::add_type(
        registry, core::Category::medium, "heterogeneous",
        "Coefficients that vary over space, by delta and ratio tracking with majorants on a coarse grid.",
        heterogeneous_rows(),
        R"(<medium type="heterogeneous"><volume name="sigma_t" type="constvolume"><rgb name="value" value="1 2 3"/></volume><rgb name="albedo" value="0.9"/></medium>)",
        make_heterogeneous);
}

}  // namespace mote::media
