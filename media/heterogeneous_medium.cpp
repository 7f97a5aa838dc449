// <medium type="heterogeneous">: the extinction is a volume; that volume builds the medium.
#include "media/heterogeneous_medium.h"

#include "core/objects/properties.h"
#include "core/objects/registry.h"
#include "media/medium_parameters.h"
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

std::shared_ptr<HeterogeneousMedium> make_heterogeneous(const core::Properties& p) {
    if (p.has("sigma_t") && p.has("density"))
        throw core::InputError("'density' is another name for 'sigma_t': give one of them", p.where);
    const auto extinction = volume_of(p, p.has("density") ? "density" : "sigma_t", Rgb(1.0f));
    MediumParts parts;
    parts.scale = float(p.get_float_in("scale", 1.0, 0.0, unlimited));
    parts.albedo = volume_of(p, "albedo", Rgb(0.75f));
    parts.phase = phase_of(p);
    parts.emission = emission_of(p);
    parts.tracking = tracking_settings_of(p);
    const float largest_albedo = core::max_component(parts.albedo->upper_bound());
    if (largest_albedo > 1.0f)
        throw core::InputError("'albedo' reaches " + std::to_string(largest_albedo) + ", above 1",
                               p.where_of("albedo"));
    auto medium = extinction->make_medium(std::move(parts));
    if (!std::isfinite(medium->majorant()))
        throw core::InputError("the extinction times 'scale' is too large for a number", p.where);
    if (medium->traits().empty) p.warn("the medium is empty: it is treated as vacuum");
    return medium;
}

}  // namespace

void register_heterogeneous_medium(core::Registry& registry) {
    registry.add(
        {core::Category::medium,
         "heterogeneous",
         "Coefficients that vary over space, by delta and ratio tracking with majorants on a coarse grid.",
         {{"sigma_t", "volume", "1", "Extinction, times `scale` [1/m]."},
          {"density", "volume", "", "Another name for sigma_t (that of version 0.x)."},
          {"albedo", "volume", "0.75", "Single-scattering albedo, 0 to 1."},
          {"scale", "float", "1", "Multiplies the extinction."},
          {"phase", "phase", "isotropic", "The phase function."},
          {"Le", "volume", "0", "Emitted radiance [W/(m^2 sr)]; the source term is sigma_a Le, as in pbrt."},
          {"Lescale", "float", "1", "Multiplies Le, or the black body's relative radiance."},
          {"temperature", "volume", "", "Black-body emission instead of Le: temperature, see the next two."},
          {"temperature_scale", "float", "1",
           "Kelvin = (temperature - temperature_offset) * temperature_scale."},
          {"temperature_offset", "float", "0", "See temperature_scale."},
          {"transmittance", "string", "automatic",
           "Estimator of shadow rays: unbiased_ray_marching (a tenth of the variance of tracking at its "
           "time, "
           "and automatic wherever cells vary), residual_ratio_tracking (exact in constant cells), "
           "ratio_tracking, delta_tracking (most variance), or ray_marching (a small bias, 20 to 80 times "
           "the "
           "time); docs/media.md has the table."},
          {"marching_tolerance", "float", "0.001",
           "Relative error of the optical depth that ray_marching aims at."}},
         R"(<medium type="heterogeneous"><volume name="sigma_t" type="constvolume"><rgb name="value" value="1 2 3"/></volume><rgb name="albedo" value="0.9"/></medium>)"},
        make_heterogeneous);
}

}  // namespace mote::media
