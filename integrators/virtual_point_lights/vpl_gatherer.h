// The gather of a task of `mote_vpl`: at each receiver of its eye paths the light of selected virtual point
// lights, as far as it is visible, and what the bound removed of it.
#pragma once

#include "integrators/virtual_point_lights/eye_receivers.h"

namespace mote::integrators {

/// Shared by all tasks of a pass.
struct VplPass {
    const lights::VplSet& vpls;
    const lights::VplSelector& selector;
    lights::PreparedVisibility& visibility;
    compensation::PreparedResidual& residual;
};

template <bool Media>
class VplGatherer final : public EyeReceivers<Media> {
    using Base = EyeReceivers<Media>;
    using Base::packet_, Base::settings_, Base::walk_;

  public:
    VplGatherer(const core::Scene& scene, const VplSettings& settings, const VplPass& pass,
                typename Base::Packet& packet, std::size_t task = 0)
        : Base(settings, packet, pass.visibility.of_lights()),
          scratch_(std::make_unique<lights::GatherScratch>()),
          context_{scene, *scratch_, walk_.rays, walk_.tracking, walk_.cancelled},
          selector_(pass.selector()),
          visibility_(pass.visibility),
          task_(task),
          residual_(pass.residual.for_task(pass.vpls, *scratch_, walk_)) {}

    /// Gathers at one of the eye samples of these pixels, with their share of the VPLs. Selected VPLs are not
    /// shared out: any of them may be selected, and neighbours select their own.
    void run(const PacketPixels& pixels) {
        const int samples = settings_.eye_paths();
        const bool shared_out = settings_.vpls_shared_out();
        const auto places = std::size_t(settings_.interleaving) * std::size_t(settings_.interleaving);
        const bool all = settings_.selection->takes_all();
        const std::size_t share = all ? pixels.share : 0, shares = all ? places : 1;
        const std::size_t sample = shared_out ? std::size_t(pixels.sample) : 0,
                          parts = shared_out ? std::size_t(samples) : 1;
        first_ = pixels.pixels[0], light_scale_ = 1.0f / float(samples);
        if (pixels.sample == 0) restored_ = {};
        this->follow({sample + parts * share, parts * shares}, float(parts * shares), pixels.gathers);
        if (pixels.sample + 1 == samples) gather_copied();
    }

    /// Gathers at all points that the selector has only copied: those of several eye paths, too, whose light
    /// is a sum.
    void gather_copied() {
        const lights::LightByKind light = selector_->gather_copied(context_, walk_.rng);
        for (int i = 0; i < Base::Packet::width; ++i)
            for (const bool surface : {true, false})
                packet_[i].sum[transport_layer(2, surface)] += light[surface ? 0 : 1][std::size_t(i)];
    }

    /// Writes what compensation restored, over all eye samples, to its layers: surfaces, then media.
    void store_restored(const PacketPixels& pixels, core::PassImage& image) const {
        if (!settings_.residual->restores()) return;
        pixels.for_each([&](std::size_t lane, int x, int y) {
            for (std::size_t i = 0; i < (Media ? 2u : 1u); ++i)
                image.at(transport_layer_count(Media) + i, x, y) =
                    restored_[lane][i] / float(settings_.eye_paths());
        });
    }

    void add_statistics(core::Statistics& statistics) const { selector_->add_statistics(statistics); }

  private:
    void add(int lane, const core::ScatteringVertex& vertex, const core::Rgb& throughput,
             const core::MediumState& state, std::int32_t depth) override {
        kinds_[std::size_t(lane)] =
            vertex.on_surface() ? lights::ReceiverKind::surface : lights::ReceiverKind::medium;
        receivers_.set(lane, vertex, throughput, state, core::Rng(walk_.rng.next_u32()), depth);
        residual_->add(lane, vertex, throughput, state, depth);
    }

    /// The sum over VPLs of Eqs. 10.4 and 10.5, with min(G*, b), and compensation, at all receivers.
    void gather(const lights::VplRange& range, float vpl_scale) override {
        const lights::TileLight light =
            visibility_.gather(task_, {*selector_, context_, receivers_, range, walk_.rng, first_.x, first_.y,
                                       settings_.interleaving, vpl_scale * light_scale_});
        const lights::TileLight restored = residual_->run(range, vpl_scale);
        for (std::size_t i = 0; i < light.size(); ++i) {
            const bool surface = kinds_[i] == lights::ReceiverKind::surface;
            packet_[int(i)].sum[transport_layer(2, surface)] += vpl_scale * light[i];
            restored_[i][std::size_t(kinds_[i])] += restored[i];
        }
        receivers_.clear();
    }

    std::size_t max_points() const override { return selector_->max_points(); }

    std::unique_ptr<lights::GatherScratch> scratch_;
    lights::GatherContext context_;
    std::unique_ptr<lights::TileSelector> selector_;
    lights::PreparedVisibility& visibility_;
    std::size_t task_;
    std::unique_ptr<compensation::TileResidual> residual_;
    glm::ivec2 first_{0};       ///< pixel of the first lane
    float light_scale_ = 1.0f;  ///< of an eye sample
    lights::ReceiverTile receivers_;
    typename Base::template PerLane<lights::ReceiverKind> kinds_{};
    typename Base::template PerLane<std::array<core::Rgb, 2>> restored_{};  ///< by ReceiverKind
};

}  // namespace mote::integrators
