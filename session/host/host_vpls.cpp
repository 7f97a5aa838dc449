#include "session/host/host_vpls.h"

#include "compensation/light_compensation.h"
#include "compensation/vpl_compensation.h"
#include "core/objects/properties.h"
#include "lights/selection/register_selection.h"
#include "lights/virtual_lights/particle_tracer.h"

namespace mote::session {

using core::Rgb;

namespace {

std::shared_ptr<const lights::Selection> selection_of(const HostLightSettings& settings) {
    core::Registry registry;
    lights::register_selection(registry);
    const std::string& type = settings.selection;
    core::Properties defaults;
    defaults.category = core::Category::selection, defaults.type = type;
    auto made = std::dynamic_pointer_cast<const lights::Selection>(registry.make(defaults));
    const std::string excluded = made->excludes({.compensation = settings.compensation_steps != 0});
    if (!excluded.empty()) throw core::InputError("selection '" + type + "' does not go with " + excluded);
    return made;
}

class Vpls final : public HostLight::Method {
  public:
    Vpls(const HostScene& host, const HostLightSettings& settings)
        : host_(host),
          settings_(settings),
          selection_(selection_of(settings)),
          vpls_(lights::trace_light_paths(host.scene(), {.paths = settings.paths}, settings.seed, 0,
                                          core::SamplerKind::sobol)),
          transport_(host.scene(), settings.bound, {}) {}

    std::size_t size() const override { return vpls_.lights.size(); }
    std::vector<Rgb> reflected(std::span<const HostReceiver> receivers) const override;

  private:
    struct Work;
    lights::VplSelector prepared(std::span<const HostReceiver> receivers, Work& work) const;
    template <bool Media>
    void compensate(std::span<const core::ScatteringVertex> vertices, Work& work,
                    lights::TileLight& light) const;

    const HostScene& host_;
    HostLightSettings settings_;
    std::shared_ptr<const lights::Selection> selection_;
    lights::VplSet vpls_;
    compensation::ResidualTransport transport_;
};

/// Memory and random numbers of one call.
struct Vpls::Work {
    lights::GatherScratch scratch;
    core::WalkContext walk;
    core::Rng rng;
    core::Statistics statistics;
    compensation::VplCompensationScratch residual;
};

lights::VplSelector Vpls::prepared(std::span<const HostReceiver> receivers, Work& work) const {
    // Those that the selection learns from, evenly among all.
    std::vector<lights::PathReceiver> samples;
    const std::size_t count = std::min(selection_->receiver_paths(), receivers.size());
    for (std::size_t i = 0; i < count; ++i)
        samples.push_back({host_.vertex(receivers[i * receivers.size() / count]), Rgb(1.0f),
                           host_.scene().medium_state(), 65535});
    return selection_->prepare({host_.scene(),
                                vpls_,
                                settings_.bound,
                                core::hash_keys(settings_.seed, 1),
                                work.walk.rays,
                                work.walk.tracking,
                                work.statistics,
                                {},
                                samples});
}

/// Adds what the bound takes: the light that the steps' vertices reflect, of the lamps and of the VPLs.
template <bool Media>
void Vpls::compensate(std::span<const core::ScatteringVertex> vertices, Work& work,
                      lights::TileLight& light) const {
    const lights::GatherContext context{host_.scene(), work.scratch, work.walk.rays, work.walk.tracking};
    compensation::CompensatedTile paths;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const auto path =
            transport_.start(vertices[i], host_.scene().medium_state(), Rgb(1.0f), work.walk.rng);
        paths[i] = {path, core::Rng(work.rng.next_u32()), 65535};
        light[i] += compensation::compensation_from_lights<Media>(
            host_.scene(), transport_, path, settings_.compensation_steps, work.walk, work.residual.vertices);
    }
    const auto more = compensation::compensation_from_vpls<Media>(
        {transport_, compensation::Strategy::one_to_n, settings_.compensation_steps, vpls_, {}}, paths,
        work.residual, context, work.walk);
    for (std::size_t i = 0; i < vertices.size(); ++i) light[i] += more[i];
}

std::vector<Rgb> Vpls::reflected(std::span<const HostReceiver> receivers) const {
    if (receivers.empty()) return {};
    Work work;
    work.rng = core::Rng(core::hash_keys(settings_.seed, 0x76706c73ull));
    work.walk.rng = core::Rng(work.rng.next_u32());
    const lights::VplSelector make = prepared(receivers, work);
    const auto selector = make();
    const lights::GatherContext context{host_.scene(), work.scratch, work.walk.rays, work.walk.tracking};
    return in_tiles(host_, receivers, work.rng, [&](const auto& vertices, lights::ReceiverTile& tile, int) {
        lights::TracedVisibility visibility(context, tile);
        lights::TileLight light = selector->gather(context, tile, {}, visibility, work.rng);
        const auto copied =
            selector->gather_copied(context, work.rng)[std::size_t(lights::ReceiverKind::surface)];
        for (std::size_t i = 0; i < light.size(); ++i) light[i] += copied[i];
        if (settings_.compensation_steps != 0)
            host_.has_fog() ? compensate<true>(vertices, work, light)
                            : compensate<false>(vertices, work, light);
        return light;
    });
}

}  // namespace

std::unique_ptr<const HostLight::Method> host_vpls(const HostScene& host, const HostLightSettings& settings) {
    return std::make_unique<Vpls>(host, settings);
}

}  // namespace mote::session
