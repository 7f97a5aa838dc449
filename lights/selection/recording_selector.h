// A selector that records which VPLs bring light to one lane, while another one selects: for a viewer. The
// gathered light has the same bits.
#pragma once

#include "lights/selection/selection.h"

namespace mote::lights {

/// A VPL that was connected with the receivers of a lane.
struct RecordedVpl {
    ChosenVpl chosen;
    float bounded;  ///< fraction of its light that the bound left; NaN: not known
};

/// Light of one lane.
struct LaneRecord {
    int lane = -1;  ///< -1: nothing is recorded
    float bound;    ///< b [1/m^2], infinity for none
    std::vector<RecordedVpl> vpls = {};
    core::Rgb residual{0.0f};  ///< light of all VPLs of the ranges that the bound removed
};

class RecordingSelector final : public TileSelector {
  public:
    RecordingSelector(std::unique_ptr<TileSelector> selector, const VplSet& vpls, LaneRecord& record)
        : selector_(std::move(selector)), vpls_(vpls), record_(record) {}
    TileLight gather(const GatherContext& context, ReceiverTile& receivers, const VplRange& range,
                     BatchVisibility& visibility, core::Rng& rng) override;
    LightByKind gather_copied(const GatherContext& context, core::Rng& rng) override;
    std::size_t max_points() const override { return selector_->max_points(); }
    void add_statistics(core::Statistics& s) const override { selector_->add_statistics(s); }

  private:
    void record_residual(const GatherContext& context, const ReceiverTile& receivers, const VplRange& range);
    void record_chosen();

    std::unique_ptr<TileSelector> selector_;
    const VplSet& vpls_;
    LaneRecord& record_;
};

}  // namespace mote::lights
