// Selectors over the callbacks of another renderer keep what they need of the selection they come from.
#include <algorithm>

#include "core/materials/bsdfs.h"
#include "core/materials/textures.h"
#include "core/objects/properties.h"
#include "core/scene/callback_scene.h"
#include "lights/emitters/emitters.h"
#include "lights/selection/register_selection.h"
#include "lights/virtual_lights/particle_tracer.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;

namespace {

/// The inside of a unit cube, grey.
std::optional<SurfaceHit> hit(const ForeignSurface& wall, const Ray& ray) {
    float nearest = infinity;
    Vec3 normal(0.0f);
    for (int axis = 0; axis < 3; ++axis) {
        const float d = ray.direction[axis], t = ((d > 0.0f ? 1.0f : 0.0f) - ray.origin[axis]) / d;
        if (d == 0.0f || t >= nearest) continue;
        nearest = t, normal = Vec3(0.0f), normal[axis] = d > 0.0f ? -1.0f : 1.0f;
    }
    if (!(nearest > ray.t_min && nearest < ray.t_max)) return {};
    return wall.hit(ray, nearest, normal, 1e-6f);
}

struct Room {
    ForeignSurface wall{make_diffuse(make_constant_texture(Rgb(0.5f)))};
    CallbackScene scene{{.first_hit = [this](const Ray& ray) { return hit(wall, ray); },
                         .emitters = {lights::make_point_light({0.4, 0.5, 0.6}, Rgb(2.0f))},
                         .bounds = {Vec3(0.0f), Vec3(1.0f)}}};

    ScatteringVertex vertex(Rng& rng) const {
        const Ray ray{{rng.next_float(), 0.5f, rng.next_float()}, Vec3(0.0f, -1.0f, 0.0f)};
        WalkEvent arrived;
        arrived.kind = WalkEvent::Kind::surface, arrived.hit = *scene.first_hit(ray);
        return make_vertex(arrived, ray);
    }
};

std::shared_ptr<const lights::Selection> selection_of(const std::string& type) {
    Registry registry;
    lights::register_selection(registry);
    Properties properties;
    properties.category = Category::selection, properties.type = type;
    return std::dynamic_pointer_cast<const lights::Selection>(
        registry.factory(Category::selection, type)(properties));
}

/// Light of four tiles. `kept`: whether what prepare() returned outlives the selector.
std::vector<Rgb> gathered(const Room& room, const lights::VplSet& vpls, const std::string& type, bool kept) {
    const auto selection = selection_of(type);
    RayCounters rays;
    TrackingCounters tracking;
    Statistics statistics;
    Rng rng(5);
    std::vector<lights::PathReceiver> samples;
    for (std::size_t i = 0; i < selection->receiver_paths(); ++i)
        samples.push_back({room.vertex(rng), Rgb(1.0f), {}, 1000});
    lights::VplSelector make =
        selection->prepare({room.scene, vpls, 4.0f, 1, rays, tracking, statistics, {}, samples});
    const auto selector = make();
    if (!kept) make = {};
    // Memory that was freed is overwritten.
    std::vector<std::vector<float>> others;
    for (std::size_t size = 8; size < 1 << 18; size *= 2) others.emplace_back(size, 1e30f);
    lights::GatherScratch scratch;
    const lights::GatherContext context{room.scene, scratch, rays, tracking};
    std::vector<Rgb> light;
    for (int t = 0; t < 4; ++t) {
        std::array<ScatteringVertex, lights::ReceiverLanes::width> vertices;
        lights::ReceiverTile tile;
        for (int lane = 0; lane < lights::ReceiverLanes::width; ++lane) {
            vertices[std::size_t(lane)] = room.vertex(rng);
            tile.set(lane, vertices[std::size_t(lane)], Rgb(1.0f), {}, rng, 1000);
        }
        lights::TracedVisibility visibility(context, tile);
        lights::TileLight sum = selector->gather(context, tile, {}, visibility, rng);
        const auto copied = selector->gather_copied(context, rng)[std::size_t(lights::ReceiverKind::surface)];
        for (std::size_t i = 0; i < sum.size(); ++i) light.push_back(sum[i] + copied[i]);
    }
    return light;
}

}  // namespace

TEST_CASE("A selector outlives the prepared selection that made it", "[selection]") {
    const Room room;
    const auto vpls = lights::trace_light_paths(room.scene, {.paths = 512}, 1, 0, SamplerKind::sobol);
    for (const std::string type : {"all", "uniform", "lightcuts", "multidimensional_lightcuts",
                                   "stochastic_lightcuts", "light_tree", "resampling", "matrix"}) {
        CAPTURE(type);
        const std::vector<Rgb> expected = gathered(room, vpls, type, true),
                               found = gathered(room, vpls, type, false);
        REQUIRE(found.size() == expected.size());
        CHECK(std::any_of(expected.begin(), expected.end(), [](const Rgb& l) { return l.x > 0.0f; }));
        CHECK(std::equal(found.begin(), found.end(), expected.begin()));
    }
}
