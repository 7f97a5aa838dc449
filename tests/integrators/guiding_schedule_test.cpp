// Training of guided paths: within its budget, the same bits however passes are shared out, and extremes.
#include <tbb/global_control.h>

#include <fmt/format.h>

#include "core/objects/memory_error.h"
#include "core/render/counted_work.h"
#include "core/render/render_driver.h"
#include "integrators/path_tracing/guided_paths.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::core;
using namespace mote::tests;
using integrators::Guiding, integrators::TrainedGuides;

namespace {

constexpr int size = 16;
const std::string fog_in_box =
    box(grey, fog("0.5, 1, 2", R"(<phase type="hg"><float name="g" value="0.7"/></phase>)"));

std::shared_ptr<const Integrator> guided(const std::string& type, const std::string& mode, double share,
                                         const std::string& more = "") {
    return integrator_from(fmt::format(
        R"(<integrator type="{}"><string name="guiding" value="{}"/><integer name="guiding_paths" value="256"/>
        <float name="guiding_share" value="{}"/><float name="guiding_leaf_samples" value="500"/>{}</integrator>)",
        type, mode, share, more));
}

RenderOptions options_of(const Scene& scene) {
    return {.seed = 3, .width = scene.film().width, .height = scene.film().height};
}

/// One pass.
std::vector<Rgb> picture(Estimator& estimator, const Scene& scene, const Integrator& integrator,
                         std::uint32_t pass) {
    const auto filter = make_pixel_filter("box", 0.5f, 0.5f);
    const std::atomic<bool> cancelled{false};
    const std::size_t layers = integrator.layers(scene).size();
    PassImage image(scene.film().width, scene.film().height, layers);
    REQUIRE(estimator.pass({pass, *filter, cancelled}, image));
    std::vector<Rgb> all;
    for (std::size_t l = 0; l < layers; ++l)
        all.insert(all.end(), image.layer(l).begin(), image.layer(l).end());
    return all;
}

bool same(const std::vector<Rgb>& a, const std::vector<Rgb>& b) { return a == b; }

}  // namespace

TEST_CASE("Training stays within its share of the counted work", "[guiding]") {
    // At most 0.15 of the picture's, with the default of 0.1: paths of the picture and of the training cost
    // the same on average, by counts that vary little between passes.
    const auto scene = scene_from(fog_in_box, size);
    for (const char* mode : {"on", "automatic"}) {
        const auto integrator = guided("volpath", mode, 0.1);
        const auto estimator = integrator->prepare(*scene, options_of(*scene));
        for (std::uint32_t pass = 0; pass < 400; ++pass) {
            picture(*estimator, *scene, *integrator, pass);
            if (pass != 50 && pass != 399) continue;
            Statistics s;
            estimator->add_statistics(s);
            const double training = s.values.at("guiding_work"), picture = counted_work(s) - training;
            CAPTURE(mode, pass, training, picture, s.values.at("guiding_passes"));
            CHECK(s.values.at("guiding_passes") > 1.0);
            CHECK(training < 0.15 * picture);
            if (pass == 399 && std::string(mode) == "on") CHECK(training > 0.07 * picture);
        }
    }
}

TEST_CASE("A guide of a pass depends on its number alone", "[guiding]") {
    // Rendered in order; a share of the passes on another machine, or after a resume; earlier ones again; on
    // one thread.
    const auto scene = scene_from(fog_in_box, size);
    for (const char* type : {"path", "volpath"})
        for (const char* mode : {"on", "automatic"}) {
            CAPTURE(type, mode);
            const auto integrator = guided(type, mode, 2.0);
            const auto whole = integrator->prepare(*scene, options_of(*scene));
            std::vector<std::vector<Rgb>> passes;
            for (std::uint32_t pass = 0; pass < 24; ++pass)
                passes.push_back(picture(*whole, *scene, *integrator, pass));
            const auto part = integrator->prepare(*scene, options_of(*scene));
            for (const std::uint32_t pass : {20u, 23u, 7u})
                CHECK(same(picture(*part, *scene, *integrator, pass), passes[pass]));
            const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
            const auto alone = integrator->prepare(*scene, options_of(*scene));
            CHECK(same(picture(*alone, *scene, *integrator, 23), passes[23]));
            // It would be seen: another pass of training is another picture.
            const auto more = guided(type, "on", 2.3);
            CHECK_FALSE(
                same(picture(*more->prepare(*scene, options_of(*scene)), *scene, *more, 23), passes[23]));
        }
}

TEST_CASE("A cancelled training begins anew", "[guiding]") {
    const auto scene = scene_from(fog_in_box, size);
    integrators::PathSettings settings;
    settings.guiding = {.mode = Guiding::on, .passes = 5, .paths = 256, .share = 1.0};
    integrators::SharedCounters counters;
    TrainedGuides<true> guides(*scene, options_of(*scene), settings, 1.0, counters);
    const std::atomic<bool> now{true};
    CHECK_THROWS_AS(guides.guide_of(100, now), Cancelled);
    guides.guide_of(100, {});
    CHECK(guides.passes() == 5);
    TrainedGuides<true> fresh(*scene, options_of(*scene), settings, 1.0, counters);
    fresh.guide_of(100, {});
    CHECK(guides.work() == fresh.work());
    CHECK(guides.learned().media().at(Vec3(0.1f)).pdf_solid_angle({0.0f, 1.0f, 0.0f}) ==
          fresh.learned().media().at(Vec3(0.1f)).pdf_solid_angle({0.0f, 1.0f, 0.0f}));
}

TEST_CASE("Fields beyond the memory are refused before the first pass", "[guiding]") {
    const auto scene = scene_from(fog_in_box, size);
    RenderOptions options = options_of(*scene);
    options.memory = MemoryBudget(64e6);
    CHECK_NOTHROW(guided("volpath", "on", 1.0, R"(<float name="guiding_memory" value="16"/>)")
                      ->prepare(*scene, options));
    CHECK_THROWS_AS(guided("volpath", "on", 1.0, R"(<float name="guiding_memory" value="100"/>)")
                        ->prepare(*scene, options),
                    OutOfMemory);
    const auto many = integrator_from(
        R"(<integrator type="volpath"><string name="guiding" value="on"/><integer name="guiding_paths" value="100000"/></integrator>)");
    CHECK_THROWS_AS(many->prepare(*scene, options), OutOfMemory);
}

// Outside of the medium: within, the square of what arrives has no mean, and a z-test no meaning.
TEST_CASE("Guided paths keep the mean under delta lights", "[guiding][extremes]") {
    std::string xml = box(mixed, fog("0.5, 1, 2", ""));
    xml.insert(xml.find("<sensor"),
               R"(<emitter type="point"><point name="position" x="-0.4" y="0.93" z="0.2"/></emitter>)");
    const auto begin = xml.find("<emitter type=\"area\">");
    xml.erase(begin, xml.find("</emitter>", begin) + 10 - begin);
    const auto scene = scene_from(xml, size);
    const auto on = render_statistics(*scene, *guided("volpath", "on", 2.0), {8, 1000, 5});
    const auto off = render_statistics(*scene, *guided("volpath", "off", 2.0), {8, 1000, 6});
    for (const std::string& layer : off.layers) check_same_mean(on, layer, off, layer);
    check_same_mean(on, "beauty", off, "beauty", {1.2});
}
