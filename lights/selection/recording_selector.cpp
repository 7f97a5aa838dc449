#include "lights/selection/recording_selector.h"

#include <cmath>
#include <limits>

namespace mote::lights {

using namespace core;

namespace {

constexpr float not_known = std::numeric_limits<float>::quiet_NaN();

float sum_at(const LaneLight& light, int lane) { return light.r[lane] + light.g[lane] + light.b[lane]; }

/// Records the light of each VPL at a lane after another visibility.
class RecordingVisibility final : public BatchVisibility {
  public:
    RecordingVisibility(BatchVisibility& visibility, const VplSet& vpls, LaneRecord& record, float scale)
        : visibility_(visibility), vpls_(vpls), record_(record), scale_(scale) {}
    void operator()(std::span<ShadowPacket> packets, std::span<LaneLight> light) override {
        const std::size_t first = record_.vpls.size();
        for (const LaneLight& l : light) record_.vpls.push_back(unoccluded(l));
        visibility_(packets, light);
        for (std::size_t i = 0; i < light.size(); ++i) {
            const LaneLight& l = light[i];
            record_.vpls[first + i].chosen.light =
                scale_ * Rgb(l.r[record_.lane], l.g[record_.lane], l.b[record_.lane]);
        }
    }

  private:
    /// Weight and bounded fraction of a VPL, from its unoccluded light.
    RecordedVpl unoccluded(const LaneLight& light) const {
        ShadowPacket packet;
        LaneLight bounded, all;
        contributions_of(vpls_, {light.vpl}, *light.receivers, BoundedGeometry{record_.bound}, packet,
                         bounded);
        contributions_of(vpls_, {light.vpl}, *light.receivers, UnboundedGeometry{}, packet, all);
        const float b = sum_at(bounded, record_.lane), a = sum_at(all, record_.lane);
        return {{light.vpl, scale_ * (b > 0.0f ? sum_at(light, record_.lane) / b : 1.0f)},
                a > 0.0f ? b / a : 1.0f};
    }

    BatchVisibility& visibility_;
    const VplSet& vpls_;
    LaneRecord& record_;
    float scale_;
};

/// A copy of one lane of a tile.
ReceiverTile lane_of(const ReceiverTile& receivers, int lane) {
    ReceiverTile tile = receivers;
    for (int i = 0; i < ReceiverTile::width; ++i)
        if (i != lane) tile.max_vpl_depth[i] = 0;
    return tile;
}

}  // namespace

TileLight RecordingSelector::gather(const GatherContext& context, ReceiverTile& receivers,
                                    const VplRange& range, BatchVisibility& visibility, Rng& rng) {
    if (record_.lane < 0 || receivers.max_vpl_depth[record_.lane] == 0)
        return selector_->gather(context, receivers, range, visibility, rng);
    record_residual(context, receivers, range);
    RecordingVisibility recording(visibility, vpls_, record_, float(range.stride));
    const TileLight light = selector_->gather(context, receivers, range, recording, rng);
    if (!is_black(light[std::size_t(record_.lane)])) record_chosen();
    return light;
}

LightByKind RecordingSelector::gather_copied(const GatherContext& context, Rng& rng) {
    const LightByKind light = selector_->gather_copied(context, rng);
    if (record_.lane < 0) return light;
    const auto lane = std::size_t(record_.lane);
    if (!is_black(light[0][lane]) || !is_black(light[1][lane])) record_chosen();
    return light;
}

void RecordingSelector::record_chosen() {
    for (const ChosenVpl& chosen : selector_->chosen(record_.lane))
        record_.vpls.push_back({chosen, not_known});
}

void RecordingSelector::record_residual(const GatherContext& context, const ReceiverTile& receivers,
                                        const VplRange& range) {
    if (!std::isfinite(record_.bound)) return;
    ReceiverTile tile = lane_of(receivers, record_.lane);
    const TileLight residual = lights::gather(context, vpls_, range, ResidualGeometry{record_.bound}, tile);
    record_.residual += float(range.stride) * residual[std::size_t(record_.lane)];
}

}  // namespace mote::lights
