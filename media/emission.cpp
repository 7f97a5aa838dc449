// Emission of a medium, and its parameters.
#include "media/emission.h"

#include "core/objects/properties.h"
#include "media/blackbody.h"
#include "media/medium_parameters.h"
#include "media/volume.h"

namespace mote::media {

using core::Rgb;

Rgb Emission::at(const core::Vec3& p) const {
    if (temperature) {
        const float kelvin = (temperature->eval(p).x - temperature_offset) * temperature_scale;
        return scale * blackbody->at(kelvin);
    }
    return radiance ? scale * radiance->eval(p) : Rgb(0.0f);
}

Emission emission_of(const core::Properties& p) {
    Emission e;
    e.scale = float(p.get_float_in("Lescale", 1.0, 0.0, unlimited));
    e.temperature_scale = float(p.get_float("temperature_scale", 1.0));
    e.temperature_offset = float(p.get_float("temperature_offset", 0.0));
    e.temperature = p.child<Volume>("temperature");
    const auto radiance = volume_of(p, "Le", Rgb(0.0f));
    if (!core::is_black(radiance->upper_bound())) e.radiance = radiance;
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
    return e;
}

}  // namespace mote::media
