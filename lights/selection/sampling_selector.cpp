#include "lights/selection/sampling_selector.h"

namespace mote::lights {

TileLight SamplingSelector::gather(const GatherContext& context, ReceiverTile& receivers, const VplRange&,
                                   BatchVisibility& visibility, core::Rng& rng) {
    if (!receivers.any_active) return {};
    core::Rng choices = choices_of(rng);
    const SampledVpls samples{sample(receivers, choices)};
    if (!learns()) return gather_with(context, vpls_, samples, bound_, receivers, visibility);
    std::size_t next = 0;  // the gather leaves out VPLs that send nothing
    const auto record = [&](const LaneLight& light) {
        while (samples.samples[next].index != light.vpl) record_light(next++, 0.0);
        double arrived = 0.0;
        for (int i = 0; i < LaneLight::width; ++i) arrived += double(light.r[i] + light.g[i] + light.b[i]);
        record_light(next++, arrived / 3.0);
    };
    const TileLight sum = gather_with(context, vpls_, samples, bound_, receivers, visibility, record);
    while (next < samples.samples.size()) record_light(next++, 0.0);
    return sum;
}

}  // namespace mote::lights
