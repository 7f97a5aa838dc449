#include "lights/selection/selection.h"

#include <fmt/format.h>

namespace mote::lights {

using namespace core;

namespace {

class AllTileSelector final : public TileSelector {
  public:
    AllTileSelector(const VplSet& vpls, float bound) : vpls_(vpls), bound_{bound} {}
    TileLight gather(const GatherContext& context, ReceiverTile& receivers, const VplRange& range,
                     BatchVisibility& visibility, Rng&) override {
        return gather_with(context, vpls_, range, bound_, receivers, visibility);
    }

  private:
    const VplSet& vpls_;
    BoundedGeometry bound_;
};

class AllVpls final : public Selection {
  public:
    bool is_unbiased() const override { return true; }
    VplSelector prepare(const SelectionPass& pass) const override {
        return [&vpls = pass.vpls, bound = pass.bound] {
            return std::make_unique<AllTileSelector>(vpls, bound);
        };
    }
    bool takes_all() const override { return true; }
    std::string excludes(const GatherOptions&) const override { return ""; }
    std::size_t memory_bytes(std::size_t) const override { return 0; }
    void plan(Plan& plan, const SelectionSize&) const override {
        plan.run("selection", "all VPLs at every receiver", "exact, time grows with the number of VPLs");
    }
};

}  // namespace

ReceiverKind TileSelector::kind_of(const ReceiverLanes& receivers) {
    int lane = 0;
    while (lane + 1 < ReceiverLanes::width && receivers.max_vpl_depth[lane] == 0) ++lane;
    return receivers.in_medium[lane] != 0.0f ? ReceiverKind::medium : ReceiverKind::surface;
}

ReceiverTile TileSelector::lanes_of(const ReceiverTile& receivers, ReceiverKind kind) {
    ReceiverTile tile = receivers;
    tile.any_active = tile.any_directional = false;
    for (int i = 0; i < ReceiverTile::width; ++i)
        if (tile.max_vpl_depth[i] != 0 && (tile.in_medium[i] != 0.0f) == (kind == ReceiverKind::medium))
            tile.any_active = true, tile.any_directional |= tile.directional[i] != nullptr;
        else
            tile.max_vpl_depth[i] = 0, tile.directional[i] = nullptr;
    return tile;
}

std::string Selection::excludes(const GatherOptions& options) const {
    return options.compensation         ? "compensation"
           : options.roughness_clamping ? "roughness_clamping"
           : options.shadow_maps        ? "shadow maps"
                                        : "";
}

void Selection::check_memory(const SelectionPass& pass) const {
    const std::size_t vpls = pass.vpls.lights.size(), bytes = memory_bytes(vpls);
    if (bytes > max_bytes)
        throw InputError(
            fmt::format("selecting from {} virtual point lights takes {:.0f} MB while it is built, more "
                        "than the {:.0f} MB that a selection may take",
                        vpls, double(bytes) * 1e-6, double(max_bytes) * 1e-6),
            where);
    pass.memory.require(double(bytes), fmt::format("selecting from {} virtual point lights", vpls),
                        [&](double available) {
                            return fmt::format("about {:.0f} fit", available / double(bytes) * double(vpls));
                        });
}

void Selection::plan_memory(Plan& plan, const std::string& topic, const SelectionSize& size) const {
    const std::size_t bytes = memory_bytes(std::size_t(size.vpls));
    plan.run(topic, fmt::format("{:.1f} MB", double(bytes) * 1e-6),
             fmt::format("at most {:.0f} bytes a VPL while it is built, besides the VPL's own{}",
                         double(memory_bytes(1000)) * 1e-3,
                         bytes > max_bytes
                             ? fmt::format("; more than {:.4g} MB, refused", double(max_bytes) * 1e-6)
                             : ""));
}

std::shared_ptr<Selection> all_vpls() { return std::make_shared<AllVpls>(); }

}  // namespace mote::lights
