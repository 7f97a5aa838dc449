// Selectors keep what they need of the prepared selection that they come from.
#include <algorithm>

#include "core/objects/properties.h"
#include "lights/selection/selection.h"
#include "lights/virtual_lights/particle_tracer.h"
#include "tests/lights/closed_box.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::core;

namespace {

/// A place on the floor.
ScatteringVertex receiver(const Scene& scene, Rng& rng) {
    const Ray ray{{rng.next_float(), 0.5f, rng.next_float()}, Vec3(0.0f, -1.0f, 0.0f)};
    WalkEvent arrived;
    arrived.kind = WalkEvent::Kind::surface, arrived.hit = *scene.first_hit(ray);
    return make_vertex(arrived, ray);
}

std::shared_ptr<const lights::Selection> selection_of(const std::string& type) {
    Properties properties;
    properties.category = Category::selection, properties.type = type;
    return std::dynamic_pointer_cast<const lights::Selection>(tests::registry().make(properties));
}

/// Light of four tiles. `kept`: whether what prepare() returned outlives the selector.
std::vector<Rgb> gathered(const Scene& scene, const lights::VplSet& vpls, const std::string& type,
                          bool kept) {
    const auto selection = selection_of(type);
    RayCounters rays;
    TrackingCounters tracking;
    Statistics statistics;
    Rng rng(5);
    std::vector<lights::PathReceiver> samples;
    for (std::size_t i = 0; i < selection->receiver_paths(); ++i)
        samples.push_back({receiver(scene, rng), Rgb(1.0f), {}, 1000});
    lights::VplSelector make =
        selection->prepare({scene, vpls, 4.0f, 1, rays, tracking, statistics, {}, samples});
    const auto selector = make();
    if (!kept) make = {};
    // Memory that was freed is overwritten.
    std::vector<std::vector<float>> others;
    for (std::size_t size = 8; size < 1 << 18; size *= 2) others.emplace_back(size, 1e30f);
    lights::GatherScratch scratch;
    const lights::GatherContext context{scene, scratch, rays, tracking};
    std::vector<Rgb> light;
    for (int t = 0; t < 4; ++t) {
        std::array<ScatteringVertex, lights::ReceiverLanes::width> vertices;
        lights::ReceiverTile tile;
        for (int lane = 0; lane < lights::ReceiverLanes::width; ++lane) {
            vertices[std::size_t(lane)] = receiver(scene, rng);
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
    const auto scene = tests::scene_from(tests::closed_box(tests::diffuse, ""));
    const auto vpls = lights::trace_light_paths(*scene, {.paths = 512}, 1, 0, SamplerKind::sobol);
    for (const std::string type : {"all", "uniform", "lightcuts", "multidimensional_lightcuts",
                                   "stochastic_lightcuts", "light_tree", "resampling", "matrix"}) {
        CAPTURE(type);
        const std::vector<Rgb> expected = gathered(*scene, vpls, type, true),
                               found = gathered(*scene, vpls, type, false);
        REQUIRE(found.size() == expected.size());
        CHECK(std::any_of(expected.begin(), expected.end(), [](const Rgb& l) { return l.x > 0.0f; }));
        CHECK(std::equal(found.begin(), found.end(), expected.begin()));
    }
}
