// Efforts of mote_upbp: in closed form, and whatever they are, the mean is the same.
#include <cmath>

#include "core/render/pass_runner.h"
#include "integrators/upbp/effort_trials.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::tests;
using integrators::PerMerge;

namespace {

struct Mean {
    double sum = 0.0, squares = 0.0;
    int n = 0;
    void add(double x) { sum += x, squares += x * x, ++n; }
    double value() const { return sum / n; }
    double variance() const { return (squares / n - value() * value()) / (n - 1); }
};

constexpr int edge = 8, passes = 600;

/// Light of eye paths in all pixels, over passes.
Mean light(const Scene& scene, const integrators::UpbpSettings& settings, const PerMerge& efforts,
           std::uint64_t seed) {
    const RenderOptions options{.seed = seed, .width = edge, .height = edge};
    integrators::UpbpPasses<true> of_scene(scene, options, settings, {edge, edge});
    const auto filter = film_filter(scene);
    const std::atomic<bool> never{false};
    Mean mean;
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        const PassContext context{pass, *filter, never};
        const auto of_pass = of_scene.settings_of(0, efforts);
        integrators::UpbpLights lights;
        REQUIRE(of_scene.trace_light_paths(context, of_pass, lights));
        WalkContext walk;
        double sum = 0.0;
        of_scene.trace_eye_paths(
            context, of_pass, lights, walk,
            [](const auto& visit) {
                for (int i = 0; i < edge * edge; ++i) visit(i % edge, i / edge);
            },
            [&](int, int, const integrators::Contribution& c) { sum += double(average(c.light)); });
        mean.add(sum);
    }
    return mean;
}

double z(const Mean& a, const Mean& b) {
    return (a.value() - b.value()) / std::sqrt(a.variance() + b.variance());
}

}  // namespace

TEST_CASE("A technique takes at most a quarter of the work of the paths", "[upbp]") {
    integrators::MergeWork work;
    work.hits = {10.0, 0.0, 100.0, 400.0};
    CHECK(integrators::affordable_efforts(work, 400.0) == PerMerge{1.0, 1.0, 1.0, 0.25});
    work.hits = {200.0, 100.0, 50.0, 1e9};
    CHECK(integrators::affordable_efforts(work, 400.0) == PerMerge{0.5, 1.0, 1.0, 1.0 / 256.0});
    CHECK(integrators::affordable_efforts({}, 0.0) == integrators::full_efforts);
}

TEST_CASE("Efforts of merges change no mean", "[upbp][statistics]") {
    const auto scene = scene_from(box(grey, fog("0.6, 0.9, 1.2", "")), edge);
    integrators::UpbpSettings settings;
    settings.radius = 0.15;  // light and eye paths meet in every pass
    settings.limits.max_depth = 4;
    const auto check = [&](const char* what) {
        INFO(what);
        const Mean full = light(*scene, settings, integrators::full_efforts, 1);
        const Mean seldom = light(*scene, settings, {0.3, 0.2, 0.1, 0.25}, 2);
        INFO(full.value() << " and " << seldom.value() << ", z " << z(full, seldom));
        CHECK(std::fabs(z(full, seldom)) < 3.5);
        Mean planted = seldom;  // a forgotten effort is a factor of three or more in what merges bring
        planted.sum *= 0.8, planted.squares *= 0.8 * 0.8;
        CHECK(std::fabs(z(full, planted)) > 3.5);
    };
    settings.connections = false;
    check("merges alone");
    settings.heuristic = integrators::Heuristic::none;
    check("each merge in full");
    settings.connections = true, settings.heuristic = integrators::Heuristic::balance;
    check("connections too");
}

TEST_CASE("Crowded kernels are sought less often", "[upbp]") {
    const auto scene = scene_from(box(grey, fog("3", "")), 32);
    const RenderOptions options{.seed = 1, .width = 32, .height = 32};
    integrators::UpbpSettings settings;
    settings.radius = 0.5;
    const PerMerge efforts = integrators::efforts_by_trial<true>(*scene, options, settings);
    for (const double effort : efforts) CHECK((effort >= 1.0 / 256.0 && effort < 0.5));
    settings.radius = 1e-4;
    CHECK(integrators::efforts_by_trial<true>(*scene, options, settings)[2] == 1.0);
}
