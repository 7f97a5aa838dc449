#include "session/host/host_light.h"

#include "gathering/photon_maps/photon_tracer.h"
#include "gathering/photon_maps/surface_photon_map.h"
#include "lights/ray_lights/line_gather.h"
#include "session/host/host_vpls.h"

namespace mote::session {

using core::Rgb;

namespace {

constexpr int max_depth = 65535;

/// Virtual ray lights (Novak et al. 2012), with VPLs on surfaces.
class RayLights final : public HostLight::Method {
  public:
    RayLights(const HostScene& host, const HostLightSettings& settings)
        : host_(host),
          settings_(settings),
          media_(host.scene().media()),
          set_(lights::trace_ray_lights(host.scene(), media_, {.paths = settings.paths}, settings.seed, 0,
                                        core::SamplerKind::sobol)) {}

    std::size_t size() const override { return set_.rays.size() + set_.surface.lights.size(); }
    std::vector<Rgb> reflected(std::span<const HostReceiver> receivers) const override {
        lights::GatherScratch scratch;
        core::WalkContext walk;
        core::Rng rng(core::hash_keys(settings_.seed, 0x7261796cull));
        walk.rng = core::Rng(rng.next_u32());
        lights::LineGather gather({host_.scene(), scratch, walk.rays, walk.tracking}, set_, candidates);
        lights::LineCandidates found;
        core::Lanes around;
        std::fill(around.begin(), around.end(), host_.extinction());
        return in_tiles(host_, receivers, rng,
                        [&](const auto& /*vertices*/, lights::ReceiverTile& tile, int lanes) {
                            found.clear();
                            gather.sample_candidates(rng, lanes);
                            gather.evaluate(lights::PointReceivers(tile, around, settings_.bound), found);
                            core::Lanes steps = found.total();
                            for (float& step : steps) step /= connections;
                            return gather.to_points(found, steps, settings_.bound, tile);
                        });
    }

  private:
    static constexpr std::size_t candidates = 128;
    static constexpr float connections = 16.0f;  // of a receiver, sampled by importance

    const HostScene& host_;
    HostLightSettings settings_;
    lights::ScatteringMedia media_;
    lights::RayLightSet set_;
};

/// The estimate of Jensen 2001, Ch. 7.
class PhotonMap final : public HostLight::Method {
  public:
    PhotonMap(const HostScene& host, const HostLightSettings& settings) : host_(host), settings_(settings) {
        gathering::PhotonSettings photons;
        photons.paths.paths = settings.paths;
        map_ = gathering::SurfacePhotonMap(
            gathering::trace_photons(host.scene(), photons, settings.seed, 0, core::SamplerKind::sobol)
                .surface);
    }
    std::size_t size() const override { return map_.size(); }
    std::vector<Rgb> reflected(std::span<const HostReceiver> receivers) const override {
        std::vector<core::KdTree::Neighbour> scratch;
        std::vector<Rgb> radiance;
        radiance.reserve(receivers.size());
        for (const HostReceiver& receiver : receivers)
            radiance.push_back(map_.radiance(host_.vertex(receiver), {.neighbours = settings_.neighbours},
                                             max_depth, scratch));
        return radiance;
    }

  private:
    const HostScene& host_;
    HostLightSettings settings_;
    gathering::SurfacePhotonMap map_;
};

void check(const HostScene& host, const HostLightSettings& s) {
    const bool vpls = s.method == HostMethod::virtual_point_lights;
    if (s.paths < 1) throw core::InputError("there is at least one light path");
    if (host.scene().emitters().empty()) throw core::InputError("the scene has no lamp");
    if (!(s.bound > 0.0f)) throw core::InputError("a bound is positive; where there is none, it is left out");
    if (!vpls && s.selection != "all") throw core::InputError("a selection is of virtual point lights");
    if (s.compensation_steps != 0 && (!vpls || !std::isfinite(s.bound)))
        throw core::InputError("compensation is of virtual point lights with a bound");
    if (s.method == HostMethod::photon_map && s.neighbours < 2)
        throw core::InputError("a photon estimate has at least two neighbours");
}

std::unique_ptr<const HostLight::Method> made(const HostScene& host, const HostLightSettings& settings) {
    check(host, settings);
    switch (settings.method) {
        case HostMethod::virtual_point_lights:
            return host_vpls(host, settings);
        case HostMethod::ray_lights:
            return std::make_unique<RayLights>(host, settings);
        case HostMethod::photon_map:
            break;
    }
    return std::make_unique<PhotonMap>(host, settings);
}

}  // namespace

HostMethod host_method(const std::string& name) {
    const std::vector<std::string> names{"vpl", "ray_lights", "photon_map"};  // as in the enumeration
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
        throw core::InputError("there is no method '" + name + "'" + core::suggestion(name, names));
    return HostMethod(found - names.begin());
}

HostLight::HostLight(const HostScene& scene, const HostLightSettings& settings)
    : method_(made(scene, settings)) {}
HostLight::~HostLight() = default;
std::size_t HostLight::size() const { return method_->size(); }
std::vector<Rgb> HostLight::reflected(std::span<const HostReceiver> receivers) const {
    return method_->reflected(receivers);
}

}  // namespace mote::session
