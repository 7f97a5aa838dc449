// The VPLs of `mote_vpl` that light a pixel: its packet is gathered as in a pass, by a selector that records.
#include <fmt/format.h>

#include <limits>

#include "integrators/virtual_point_lights/vpl_estimator.h"
#include "lights/selection/recording_selector.h"

namespace mote::integrators {

using namespace core;

namespace {

/// I_j of a VPL, without the BSDF of one that looks different from different sides.
LightPoint point_of(const lights::VirtualPointLight& vpl) { return {vpl.position, vpl.intensity, vpl.depth}; }

template <bool Media>
class VplPointLights final : public PointLights, private VplEstimator<Media> {
    using Base = VplEstimator<Media>;
    using Base::bound_, Base::loop_, Base::options_, Base::residual_, Base::scene_, Base::settings_,
        Base::visibility_;

  public:
    VplPointLights(const Scene& scene, const RenderOptions& options, const VplSettings& settings)
        : Base(scene, options, settings) {}
    std::string kind() const override { return "VPL"; }

    std::vector<LightPoint> points(const PassContext& context) override {
        std::vector<LightPoint> points;
        for (const lights::VirtualPointLight& vpl : this->trace(context).lights)
            points.push_back(point_of(vpl));
        return points;
    }

    PixelLight light_of(const PassContext& context, int x, int y) override {
        const lights::VplSet vpls = this->trace(context);
        const lights::VplSelector selector = this->select(vpls, context);
        lights::LaneRecord record{.bound = bound_};
        const lights::VplSelector recording = [&] {
            return std::make_unique<lights::RecordingSelector>(selector(), vpls, record);
        };
        const VplPass shared{vpls, recording, *visibility_, *residual_};
        PassImage image(options_.width, options_.height,
                        transport_layer_count(Media) + settings_.residual->layers(Media).size());
        residual_->begin(image);
        const auto gather = [&](EyeTask<Media>& task) {
            VplGatherer<Media> gatherer(scene_, settings_, shared, task.packet(), task.index());
            task.for_each([&](const PacketPixels& pixels) {
                record.lane = pixels.lane_of(x, y);
                if (record.lane >= 0 || !settings_.selection->takes_all()) gatherer.run(pixels);
            });
        };
        loop_.run_pixel(context, image, EyeReceivers<Media>::packet_settings(settings_), x, y, gather);
        return result(vpls, record);
    }

  private:
    PixelLight result(const lights::VplSet& vpls, const lights::LaneRecord& record) const {
        const float scale = 1.0f / float(settings_.eye_paths());
        PixelLight light;
        light.connected = record.vpls.size(), light.residual = scale * record.residual;
        for (const lights::RecordedVpl& v : record.vpls)
            if (!is_black(v.chosen.light))
                light.sources.push_back({v.chosen.vpl, point_of(vpls.lights[v.chosen.vpl]),
                                         scale * v.chosen.light, double(scale * v.chosen.weight),
                                         v.chosen.cluster, v.bounded});
        light.facts = facts(vpls);
        return light;
    }
    std::vector<std::pair<std::string, std::string>> facts(const lights::VplSet& vpls) const {
        Plan plan;
        const double pixels = double(options_.width) * double(options_.height);
        settings_.selection->plan(plan, {double(vpls.lights.size()), pixels * settings_.eye_paths()});
        std::vector<std::pair<std::string, std::string>> facts{
            {"VPLs", fmt::format("{} of {} light paths", vpls.lights.size(), vpls.paths)},
            {plan.runs.front().topic, plan.runs.front().choice}};
        facts.emplace_back("bound", std::isfinite(bound_) ? fmt::format("{:.4g} 1/m^2", bound_) : "none");
        if (settings_.upsampling > 1)
            facts.emplace_back("upsampling", "pixels between the lattice gather no VPLs in this pass");
        return facts;
    }
};

}  // namespace

std::unique_ptr<PointLights> make_vpl_point_lights(const Scene& scene, const RenderOptions& options,
                                                   VplSettings settings) {
    settings.visibility = lights::traced_visibility();
    if (scene.has_media()) return std::make_unique<VplPointLights<true>>(scene, options, settings);
    return std::make_unique<VplPointLights<false>>(scene, options, settings);
}

}  // namespace mote::integrators
