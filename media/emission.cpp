// Emission of a medium, and its parameters.
#include "media/emission.h"

#include "media/blackbody.h"

namespace mote::media {

using core::Rgb;

Rgb Emission::at(const core::Vec3& p) const {
    if (temperature) {
        const float kelvin = (temperature->eval(p).x - temperature_offset) * temperature_scale;
        return scale * blackbody->at(kelvin);
    }
    return radiance ? scale * radiance->eval(p) : Rgb(0.0f);
}

const core::ParameterList<Emission>& emission_rows() {
    using namespace core;
    static const ParameterList<Emission> list{
        row("Le", &Emission::radiance, at_least(0, "W/(m^2 sr)"),
            "Emitted radiance; the source term is sigma_a Le, as in pbrt.")
            .when_absent("0"),
        row("Lescale", &Emission::scale, at_least(0),
            "Multiplies Le, or the black body's relative radiance."),
        row("temperature", &Emission::temperature, at_least(0),
            "Black-body emission instead of Le: temperature, see the next two.")
            .when_absent("none"),
        row("temperature_scale", &Emission::temperature_scale,
            "Kelvin = (temperature - temperature_offset) * temperature_scale."),
        row("temperature_offset", &Emission::temperature_offset, "See temperature_scale.")};
    return list;
}

void finish_emission(Emission& e, const core::Properties& p) {
    if (e.radiance && core::is_black(e.radiance->upper_bound())) e.radiance = nullptr;
    if (e.temperature && e.radiance)
        throw core::InputError("give either 'Le' or a 'temperature' volume, not both", p.where);
    if (e.temperature) {
        const double hottest =
            (double(e.temperature->upper_bound().x) - e.temperature_offset) * e.temperature_scale;
        const double coldest = -double(e.temperature_offset) * e.temperature_scale;
        e.blackbody = std::make_shared<BlackbodyTable>(std::fmax(hottest, coldest));
    } else if (p.has("temperature_scale") || p.has("temperature_offset")) {
        p.warn("'temperature_scale' and 'temperature_offset' have no effect without a 'temperature' volume");
    }
}

}  // namespace mote::media
