// Guided paths: the mean of unguided ones on surfaces and in media, and fields that teach the wrong
// directions and vertices change noise only. Densities that leave something out are seen.
#include <fmt/format.h>

#include <filesystem>

#include "core/render/pass_runner.h"
#include "integrators/eye_path/image_loop.h"
#include "integrators/path_tracing/guided_paths.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::core;
using namespace mote::tests;

namespace {

std::shared_ptr<const Integrator> paths(const std::string& type, const std::string& guiding,
                                        const std::string& more = "") {
    return integrator_from(fmt::format(
        R"(<integrator type="{}"><string name="guiding" value="{}"/><integer name="guiding_passes" value="39"/>
        <integer name="guiding_paths" value="2048"/><float name="guiding_leaf_samples" value="500"/>{}</integrator>)",
        type, guiding, more));
}

void check_equal(const Scene& scene, const std::string& type, std::uint32_t passes,
                 const std::string& more = "", const std::string& guiding = "on") {
    const auto guided = render_statistics(scene, *paths(type, guiding, more), {8, passes, 5});
    const auto reference = render_statistics(scene, *paths(type, "off", more), {8, passes, 6});
    for (const std::string& layer : reference.layers) check_same_mean(guided, layer, reference, layer);
    check_same_mean(guided, "beauty", reference, "beauty", {1.1});
    CHECK(guided.non_finite == 0);
}

/// A guide whose lobes point anywhere, whose density counts as `factor` times what it is; and one that
/// expects anything of vertices.
class AnyGuide final : public lights::ScatteringGuide {
  public:
    explicit AnyGuide(float factor, bool vertices = false) : factor_(factor), vertices_(vertices) {}
    int candidates() const override { return vertices_ ? 8 : 0; }
    lights::ExpectedRadiance expected(const Vec3& p, bool on_surface) const override {
        if (!vertices_) return {};
        const float mean =
            std::fabs((on_surface ? 1.0f : 0.5f) + std::sin(5.0f * p.x) * std::cos(7.0f * p.y));
        return {mean, mean, 0.5f * mean, true};
    }
    void find(const ScatteringVertex& vertex, lights::VmfMixture& lobes) const override {
        lobes.empty = true;
        if (!lights::LearnedGuide::guides(vertex)) return;
        lobes = lights::even_mixture();
        for (int k = 0; k < 3; ++k)
            lobes.kappa[k] = 20.0f, lobes.normalization[k] = lights::vmf_normalization(20.0f);
        for (float& c : lobes.normalization) c *= factor_;
    }

  private:
    float factor_;
    bool vertices_;
};

/// Paths with a guide of a test.
class PathsOf final : public Integrator {
  public:
    explicit PathsOf(const lights::ScatteringGuide& guide) : guide_(guide) {}
    std::string type() const override { return "paths_of_a_test"; }
    std::vector<Layer> layers(const Scene& scene) const override {
        return integrators::transport_layers(scene.has_media());
    }
    Plan plan(const Scene&, const Requirements&) const override { return {}; }
    std::unique_ptr<Estimator> prepare(const Scene& scene, const RenderOptions& options) const override;

  private:
    const lights::ScatteringGuide& guide_;
};

class PathsOfEstimator final : public Estimator {
  public:
    PathsOfEstimator(const Scene& scene, const RenderOptions& options, const lights::ScatteringGuide& guide)
        : scene_(scene), guide_(guide), loop_(scene, options) {}
    bool pass(const PassContext& context, PassImage& image) override {
        const integrators::EyePacketSettings eye{.limits = {}, .guide = guide_};
        return loop_.run(context, image, eye, [&](integrators::EyeTask<true>& task) {
            task.for_each([&](const integrators::PacketPixels&) {
                integrators::trace_paths<true>(scene_, {}, task.packet());
            });
        });
    }

  private:
    const Scene& scene_;
    const lights::ScatteringGuide& guide_;
    integrators::ImageLoop<true> loop_;
};

std::unique_ptr<Estimator> PathsOf::prepare(const Scene& scene, const RenderOptions& options) const {
    return std::make_unique<PathsOfEstimator>(scene, options, guide_);
}

/// Radiance 1 from all walls of a closed box: E / (1 - rho) with rho = 1/2, E = 1/2.
const std::string furnace =
    R"(<scene version="3.0.0"><shape type="cube"><boolean name="flip_normals" value="true"/>
        <bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.5"/></bsdf></bsdf>
        <emitter type="area"><rgb name="radiance" value="0.5"/></emitter></shape>
        <sensor type="perspective"><float name="fov" value="60"/><transform name="to_world">
        <lookat origin="0.1, 0.2, 0.3" target="1, 0, 0" up="0, 1, 0"/></transform></sensor></scene>)";

const std::string forward_fog = fog("0.5, 1, 2", R"(<phase type="hg"><float name="g" value="0.7"/></phase>)");

}  // namespace

TEST_CASE("Guided paths keep the mean on surfaces", "[guiding][equality]") {
    for (const std::string& material : {grey, glossy, mixed}) {
        const auto scene = scene_from(box(material, ""), 16);
        check_equal(*scene, "path", 3000);
    }
}

TEST_CASE("Guided paths keep the mean among panes and bent normals", "[guiding][equality]") {
    const auto scene = scene_from(leafy_box(""), 16);
    check_equal(*scene, "path", 3000);
}

TEST_CASE("Guided paths keep the mean in a homogeneous medium", "[guiding][equality]") {
    const auto scene = scene_from(box(grey, forward_fog), 16);
    // By 3000 a block of the picture differed by z = 3.51, against 3.40, on one processor; by these it
    // agrees.
    check_equal(*scene, "volpath", 12000);
    check_equal(*scene, "volpath", 3000, R"(<float name="vpl_bound" value="4"/>)");
}

TEST_CASE("Guided paths keep the mean in a heterogeneous medium", "[guiding][equality]") {
    const auto path = std::filesystem::temp_directory_path() / "mote_guiding.vol";
    const auto scene = scene_from(box(mixed, smoke_medium(path.string())), 16);
    check_equal(*scene, "volpath", 3000);
    std::filesystem::remove(path);
}

TEST_CASE("A guide of any directions keeps the mean; a density that is not its own does not", "[guiding]") {
    const auto scene = scene_from(box(mixed, forward_fog), 8);
    const auto reference =
        render_statistics(*scene, *integrator_from(R"(<integrator type="volpath"/>)"), {4, 3100, 1});
    const auto any = render_statistics(*scene, PathsOf(AnyGuide(1.0f)), {4, 3100, 2});
    check_same_mean(any, "beauty", reference, "beauty", {1.1});
    // Planted: lobes without their weight in the density. Its share is guide_probability: so many passes.
    auto wrong = render_statistics(*scene, PathsOf(AnyGuide(1.3f)), {4, 3100, 2});
    wrong.planted = true;
    CHECK_FALSE(same_mean(wrong, "beauty", reference, "beauty", OnFailure::nothing).passed);
}

TEST_CASE("A guide that expects anything of vertices keeps the mean", "[guiding]") {
    const auto path = std::filesystem::temp_directory_path() / "mote_guided_vertices.vol";
    for (const std::string& medium : {forward_fog, smoke_medium(path.string())}) {
        const auto scene = scene_from(box(mixed, medium), 8);
        const auto reference =
            render_statistics(*scene, *integrator_from(R"(<integrator type="volpath"/>)"), {4, 1500, 1});
        const auto any = render_statistics(*scene, PathsOf(AnyGuide(1.0f, true)), {4, 3000, 2});
        for (const std::string& layer : reference.layers) check_same_mean(any, layer, reference, layer);
        check_same_mean(any, "beauty", reference, "beauty", {1.1});
    }
    std::filesystem::remove(path);
}

TEST_CASE("Guided paths keep the mean with directions alone", "[guiding][equality]") {
    check_equal(*scene_from(box(grey, forward_fog), 16), "volpath", 3000, "", "directions");
}

TEST_CASE("Guided vertices keep the mean among panes and with lights that the camera does not see",
          "[guiding][equality]") {
    check_equal(*scene_from(leafy_box(forward_fog), 16), "volpath", 3000,
                R"(<boolean name="hide_emitters" value="true"/>)");
}

TEST_CASE("Guided vertices keep the mean with equi-angular sampling", "[guiding][equality]") {
    std::string xml = box(grey, forward_fog);
    xml.insert(xml.find("<sensor"),
               R"(<emitter type="point"><point name="position" x="0.2" y="0.3" z="0.1"/></emitter>)");
    check_equal(*scene_from(xml, 16), "volpath", 3000, R"(<boolean name="equiangular" value="true"/>)");
}

TEST_CASE("Guided vertices in media that absorb nothing are in equilibrium", "[guiding][furnace]") {
    for (const double depth : {0.01, 1.0, 30.0})
        for (const double z : {-4.0, -0.3}) {
            const auto scene = scene_from(
                fmt::format(
                    R"(<scene version="3.0.0"><emitter type="constant"/><shape type="sphere"><bsdf type="null"/>
                <medium type="homogeneous" name="interior"><float name="sigma_t" value="{}"/><float name="albedo" value="1"/>
                <phase type="hg"><float name="g" value="0.7"/></phase></medium></shape><sensor type="perspective">
                <float name="fov" value="30"/><transform name="to_world"><lookat origin="0, 0, {}" target="0, 0, 1"
                up="0, 1, 0"/></transform></sensor></scene>)",
                    depth / 2.0, z),
                8);
            CAPTURE(depth, z);
            check_mean_is(render_statistics(*scene, *paths("volpath", "on"), {4, 400, 7}), "beauty", 1.0);
        }
}

TEST_CASE("Vertices are guided unless media glow", "[guiding]") {
    const std::string glowing =
        R"(<medium type="homogeneous" name="interior"><float name="sigma_t" value="1"/><float name="albedo" value="0.5"/>
        <rgb name="Le" value="1, 2, 3"/></medium>)";
    const auto guides_vertices = [](const Scene& scene, const std::string& guiding) {
        const RenderOptions options{.width = 8, .height = 8};
        Statistics statistics;
        paths("volpath", guiding)->prepare(scene, options)->add_statistics(statistics);
        return statistics.values.at("guided_vertices") > 0.0;
    };
    const auto glow = scene_from(box(grey, glowing), 8), fog = scene_from(box(grey, forward_fog), 8);
    CHECK_FALSE(guides_vertices(*glow, "on"));
    CHECK(guides_vertices(*fog, "on"));
    CHECK_FALSE(guides_vertices(*fog, "directions"));
    check_equal(*glow, "volpath", 1500);
}

TEST_CASE("A closed furnace is one with guided paths", "[guiding]") {
    const auto scene = scene_from(furnace, 8);
    check_mean_is(render_statistics(*scene, *paths("path", "on"), {4, 400, 1}), "beauty", 1.0, {1.02});
}

TEST_CASE("A guide that is wrong makes no path heavier than eight times", "[guiding]") {
    /// One narrow lobe to the ceiling, where no more light comes from than from elsewhere.
    struct UpGuide final : lights::ScatteringGuide {
        void find(const ScatteringVertex&, lights::VmfMixture& lobes) const override {
            lobes = lights::even_mixture();
            for (int k = 0; k < lights::VmfMixture::capacity; ++k) lobes.set(k, {{0, 1, 0}, 1000.0f}, 0.125f);
        }
    } const guide;
    const auto scene = scene_from(furnace, 8);
    integrators::EyePathLimits limits;
    limits.rr_depth = limits.max_depth = 24;
    double heaviest = 0.0;
    for (std::uint64_t path = 0; path < 500; ++path) {
        WalkContext walk;
        walk.rng = Rng(path);
        const integrators::EyeRay eye{
            {Vec3(0.1f, 0.2f, 0.3f), Vec3(1, 0, 0)}, {}, {SamplerKind::independent, 1, 0, path}, walk.rng};
        integrators::EyePath<false> way(*scene, limits, eye, walk, nullptr, guide);
        integrators::TransportSum sum;
        // Without a guide each vertex halves the weight. A guide that is not followed doubles it at most:
        // twice before the path is guided no further, and once by the vertex that brings it there.
        for (double unguided = 1.0; way.advance(walk, sum); unguided *= 0.5)
            heaviest = std::max(heaviest, double(average(way.weights().throughput)) / unguided);
    }
    CHECK(heaviest < 8.0 * (1.0 + 1e-4));
    CHECK(heaviest > 3.9);
}

TEST_CASE("What is learned is where light comes from", "[guiding]") {
    // In the box the lamp hangs below the ceiling; next-event estimation finds it, so what is left to
    // directions are lit walls: at the floor they lie in the upper half space.
    const auto scene = scene_from(box(grey, ""), 16);
    RenderOptions options;
    options.width = options.height = 16, options.seed = 3;
    integrators::PathSettings settings;
    settings.guiding = {integrators::Guiding::on, 7, 4096, 1000.0, 8.0};
    integrators::SharedCounters counters;
    const integrators::GuideTraining<false> training(*scene, options, settings, 1.6, counters);
    const lights::LearnedGuide* const guide = training.guide();
    CHECK(guide->surfaces().leaves().size() > 10);
    CHECK(guide->media().leaves().empty());
    const lights::VmfMixture floor = guide->surfaces().at({-0.5f, -0.999f, 0.2f});
    REQUIRE_FALSE(floor.empty);
    double up = 0.0;
    Rng rng(1);
    for (int i = 0; i < 4000; ++i) {
        const float u = rng.next_float();
        up += floor.sample(u, rng.next_vec2()).y > 0.0f;
    }
    CHECK(up > 3200.0);
}

TEST_CASE("A pass is guided by the passes before it, in any order", "[guiding]") {
    const auto scene = scene_from(box(mixed, forward_fog), 16);
    const RenderOptions options{.seed = 4, .width = 16, .height = 16};
    const std::size_t layers = paths("volpath", "on")->layers(*scene).size();
    const std::atomic<bool> cancelled{false};
    const auto filter = film_filter(*scene);
    const auto pass = [&](Estimator& estimator, std::uint32_t index) {
        PassImage image(16, 16, layers);
        REQUIRE(estimator.pass({index, *filter, cancelled}, image));
        std::vector<Rgb> light;
        for (std::size_t l = 0; l < layers; ++l)
            light.insert(light.end(), image.layer(l).begin(), image.layer(l).end());
        return light;
    };
    std::vector<std::vector<Rgb>> expected;
    for (const char* guiding : {"automatic", "on"}) {
        const auto integrator = paths("volpath", guiding);
        const auto in_order = integrator->prepare(*scene, options),
                   alone = integrator->prepare(*scene, options);
        expected.clear();
        for (std::uint32_t i = 0; i <= 40; ++i) expected.push_back(pass(*in_order, i));
        for (const std::uint32_t i : {20u, 3u, 40u, 32u}) CHECK(pass(*alone, i) == expected[i]);
    }
    // It has learned from them.
    const auto first_only = integrator_from(
        R"(<integrator type="volpath"><string name="guiding" value="on"/><integer name="guiding_passes" value="7"/>
        <integer name="guiding_paths" value="2048"/><float name="guiding_leaf_samples" value="500"/></integrator>)");
    CHECK_FALSE(pass(*first_only->prepare(*scene, options), 20) == expected[20]);
}

TEST_CASE("A black scene and a scene of mirrors have nothing to learn", "[guiding]") {
    const std::string camera = R"(<sensor type="perspective"/></scene>)";
    const std::string dark =
        R"(<scene version="3.0.0"><shape type="sphere"><point name="center" x="0" y="0" z="4"/>
        <bsdf type="diffuse"><rgb name="reflectance" value="0"/></bsdf></shape><emitter type="point"/>)" +
        camera;
    const auto black = render_statistics(*scene_from(dark, 8), *paths("volpath", "on"), {4, 4, 1});
    CHECK(black.whole[black.layer("beauty")][0].mean == 0.0);
    const std::string mirror =
        R"(<scene version="3.0.0"><shape type="sphere"><point name="center" x="0" y="0" z="4"/>
        <bsdf type="conductor"><string name="material" value="none"/></bsdf></shape><emitter type="constant"/>)" +
        camera;
    check_mean_is(render_statistics(*scene_from(mirror, 8), *paths("path", "on"), {4, 16, 1}), "beauty", 1.0);
}

namespace {

/// The box whose lamp, a small one, shines at the ceiling from close by: all other light comes from a spot
/// there.
std::string lamp_upwards() {
    std::string xml = box(grey, "");
    const auto replace = [&](const std::string& old, const std::string& with) {
        xml.replace(xml.find(old), old.size(), with);
    };
    replace(R"(<scale value="0.25"/><rotate x="1" angle="90"/>)",
            R"(<scale value="0.06"/><rotate x="1" angle="-90"/>)");
    replace(R"(<translate y="0.95"/>)", R"(<translate y="0.9"/>)");
    return xml;
}

bool automatic_guides(const Scene& scene) {
    RenderOptions options;
    options.width = options.height = 16;
    const auto integrator =
        integrator_from(R"(<integrator type="path"><string name="guiding" value="automatic"/>
        <integer name="guiding_passes" value="15"/><integer name="guiding_paths" value="8192"/></integrator>)");
    Statistics statistics;
    integrator->prepare(scene, options)->add_statistics(statistics);
    return statistics.values.at("guided") > 0.0;
}

}  // namespace

TEST_CASE("Guided paths are quieter under a bright spot, by far", "[guiding]") {
    const auto scene = scene_from(lamp_upwards(), 16);
    const auto noise = [&](const char* guiding) {
        const auto r = render_statistics(*scene, *paths("path", guiding), {16, 256, 1});
        return r.whole[r.layer("indirect")][1].variance_of_mean;
    };
    const double guided = noise("on"), plain = noise("off");
    CAPTURE(guided, plain);
    CHECK(guided < 0.5 * plain);
}

TEST_CASE("Guiding is automatic where it pays", "[guiding]") {
    CHECK(automatic_guides(*scene_from(lamp_upwards(), 16)));
    // Under an even sky, cosines are the best directions.
    CHECK_FALSE(automatic_guides(*scene_from(
        R"(<scene version="3.0.0"><shape type="sphere"><point name="center" x="0" y="0" z="4"/><bsdf type="diffuse"/>
        </shape><emitter type="constant"/><sensor type="perspective"/></scene>)",
        16)));
}
