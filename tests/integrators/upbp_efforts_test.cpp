// Efforts of mote_upbp: a trial predicts the variance, and whatever they are, the mean is the same.
#include <cmath>
#include <numeric>

#include "core/cameras/sensors.h"
#include "core/render/render_driver.h"
#include "integrators/upbp/effort_trials.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

using namespace mote;
using namespace mote::core;
using namespace mote::tests;
using integrators::Merge;
using integrators::PerTechnique;

namespace {

struct Mean {
    double sum = 0.0, squares = 0.0;
    int n = 0;
    void add(double x) { sum += x, squares += x * x, ++n; }
    double value() const { return sum / n; }
    double variance() const { return (squares / n - value() * value()) / (n - 1); }
};

/// Light in `pixels` pixels of one row, a pass after the other: visit(std::vector<double>).
template <typename Visit>
void for_each_pass(const Scene& scene, const integrators::UpbpSettings& settings, const PerTechnique& efforts,
                   std::uint64_t seed, int count, int pixels, const Visit& visit,
                   bool always_sought = false) {
    const RenderOptions options{.seed = seed, .width = pixels, .height = 1};
    integrators::UpbpPasses<true> of_scene(scene, options, settings, {pixels, 1});
    const auto filter = make_pixel_filter("box", 0.5f, 0.5f);
    const std::atomic<bool> never{false};
    for (std::uint32_t pass = 0; pass < std::uint32_t(count); ++pass) {
        const PassContext context{pass, *filter, never};
        auto of_pass = of_scene.settings_of(integrators::trial_pass, efforts);
        of_pass.merging.always_sought = always_sought;
        integrators::UpbpLights lights;
        REQUIRE(of_scene.trace_light_paths(context, of_pass, lights));
        std::vector<double> light((std::size_t(pixels)));
        for (const auto& row : lights.splats)
            for (const integrators::Splat& splat : row)
                if (on_film(splat.film, {float(pixels), 1.0f}, 0.0f))
                    light[std::size_t(splat.film.x)] += double(average(splat.light));
        WalkContext walk;
        of_scene.trace_eye_paths(
            context, of_pass, lights, walk,
            [&](const auto& at) {
                for (int x = 0; x < pixels; ++x) at(x, 0);
            },
            [&](int x, int, const integrators::Contribution& c) {
                light[std::size_t(x)] += double(average(c.light));
            });
        visit(light);
    }
}

constexpr int edge = 32, passes = 1200;

Mean light(const Scene& scene, const integrators::UpbpSettings& settings, const PerTechnique& efforts,
           std::uint64_t seed, bool always_sought = false) {
    Mean mean;
    for_each_pass(
        scene, settings, efforts, seed, passes, edge,
        [&](const std::vector<double>& pixels) {
            mean.add(std::accumulate(pixels.begin(), pixels.end(), 0.0));
        },
        always_sought);
    return mean;
}

double z(const Mean& a, const Mean& b) {
    return (a.value() - b.value()) / std::sqrt(a.variance() + b.variance());
}

}  // namespace

TEST_CASE("A trial's samples give the variance at any efforts", "[upbp]") {
    integrators::Trial trial;
    // A query of two merges, and a connection with a ray of its own, in pass A; nothing in B.
    integrators::TrialPixel pixel;
    PerTechnique all{}, half{};
    all[3] = 1.0, half[3] = 0.5;
    pixel[0] = {{.light = 1.0f, .share = all, .technique = 3, .query = 1},
                {.light = 3.0f, .share = half, .technique = 3, .query = 1},
                {.light = 2.0f, .share = half}};
    trial.pixels = {pixel}, trial.weights = {1.0};
    CHECK(integrators::variance_at(trial, integrators::full_efforts) == Approx(0.5 * 36.0));
    // At 1/4: 1 / (1/4) and 3 / (5/8), each with probability 1/2 in a query of probability 1/2; 2 / (5/8).
    const PerTechnique seldom{1.0, 1.0, 1.0, 0.25, 1.0};
    const double query = 4.0 + 4.8, squares = 16.0 + 4.8 * 4.8, mean = 0.25 * query + 3.2;
    const double moment = 0.5 * (0.25 * query * query + 0.25 * squares);
    const double expected = 0.5 * (mean * mean + moment - 0.0625 * query * query);
    CHECK(integrators::variance_at(trial, seldom) == Approx(expected));
    trial.weights = {3.0};
    CHECK(integrators::variance_at(trial, seldom) == Approx(3.0 * expected));
    trial.pixels.clear(), trial.weights = {1.0};
    trial.splats = {{{.light = 2.0f, .share = half}, 0}};
    CHECK(integrators::variance_at(trial, seldom) == Approx(0.5 * 3.2 * 3.2));
}

TEST_CASE("Connections of a vertex are tried together, and some have a ray by chance", "[upbp]") {
    integrators::Trial trial;
    integrators::TrialPixel pixel;
    PerTechnique half{};
    half[integrators::by_connection] = 0.5;
    pixel[0] = {{.light = 1.0f, .share = half, .technique = integrators::by_connection, .query = 2},
                {.light = 2.0f,
                 .weight = 0.05f,
                 .share = half,
                 .technique = integrators::by_connection,
                 .query = 2,
                 .needs_ray = true}};
    trial.pixels = {pixel}, trial.weights = {1.0};
    // With an effort of 1/4 half of the density is left in 5/8: 1.6 and 3.2, which has a ray with the chance
    // 0.05 / (5/8) / 0.25 = 0.32.
    const PerTechnique seldom{1.0, 1.0, 1.0, 1.0, 0.25};
    const double mean = 0.25 * 4.8, moment = 0.25 * (4.8 * 4.8 + 3.2 * 3.2 * (1.0 / 0.32 - 1.0));
    CHECK(integrators::variance_at(trial, seldom) == Approx(0.5 * (mean * mean + moment - mean * mean)));
}

TEST_CASE("Variances count by the light of their surroundings, and without outliers", "[upbp]") {
    integrators::Trial trial;
    const auto lit = [](float light) {
        integrators::TrialPixel pixel;
        pixel[0] = {{.light = light}}, pixel[1] = {{.light = light}};
        return pixel;
    };
    trial.pixels.assign(64, lit(2.0f));  // a block of 64 pixels, a dark one, and one with a bright pixel
    trial.pixels.insert(trial.pixels.end(), 64, lit(0.0f));
    trial.pixels.insert(trial.pixels.end(), 64, lit(2.0f));
    trial.pixels[140] = lit(1e6f);
    integrators::set_weights_by_light(trial);
    REQUIRE(trial.weights.size() == 192);
    for (const int i : {0, 63, 128, 140, 191}) CHECK(trial.weights[std::size_t(i)] == Approx(1.0 / 4.04));
    CHECK(trial.weights[100] == Approx(1.0 / 0.04));
    trial.pixels[0][0] = {{.light = 4.0f}}, trial.pixels[140][0] = {{.light = 0.0f}};
    CHECK(integrators::variance_at(trial, integrators::full_efforts) > 1e11);
    CHECK(integrators::variance_at(trial, integrators::full_efforts, 0.01) == Approx(0.5 * 4.0 / 4.04));
}

TEST_CASE("What a technique does not bring is not sought", "[upbp]") {
    integrators::Trial trial;
    trial.work_of_paths = 1.0, trial.work.queries = {1.0, 1.0, 0.0, 1.0}, trial.work.finds[4] = 1.0;
    integrators::TrialPixel pixel;
    PerTechnique surface{}, beams{};
    surface[0] = 0.999, beams[3] = 0.5;
    pixel[0] = {{.light = 1.0f, .share = surface, .technique = 0}, {.light = 1e-6f, .share = beams}};
    trial.pixels = {pixel}, trial.weights = {1.0};
    CHECK(integrators::efficient_efforts(trial) ==
          PerTechnique{1.0, 1.0 / 64.0, 1.0, 1.0 / 64.0, 1.0 / 64.0});
    CHECK(integrators::efficient_efforts({}) == integrators::full_efforts);
}

TEST_CASE("A trial predicts the variance of a pass", "[upbp][statistics]") {
    const auto scene = scene_from(box(grey, fog("0.6, 0.9, 1.2", "")), edge);
    integrators::UpbpSettings settings;
    settings.radius = 0.15, settings.limits.max_depth = 4, settings.all_connections = true;
    for (const PerTechnique& efforts :
         {integrators::full_efforts, PerTechnique{0.25, 0.0625, 0.25, 0.0625, 0.25}}) {
        Mean predicted, planted;
        for (std::uint64_t seed = 0; seed < 16; ++seed) {
            const RenderOptions options{.seed = seed, .width = edge, .height = 1};
            integrators::Trial trial = integrators::trial_of_efforts<true>(*scene, options, settings);
            trial.weights.assign(trial.weights.size(), 1.0);
            predicted.add(integrators::variance_at(trial, efforts));
            for (auto& pixel : trial.pixels)  // shares forgotten
                for (auto& samples : pixel)
                    for (auto& sample : samples) sample.share = {};
            planted.add(integrators::variance_at(trial, efforts));
        }
        // By the difference of two passes.
        Mean measured;
        std::vector<double> before;
        for_each_pass(*scene, settings, efforts, 7, passes, edge, [&](const std::vector<double>& pixels) {
            if (before.empty()) {
                before = pixels;
                return;
            }
            double sum = 0.0;
            for (std::size_t x = 0; x < pixels.size(); ++x)
                sum += 0.5 * (pixels[x] - before[x]) * (pixels[x] - before[x]);
            measured.add(sum), before.clear();
        });
        INFO(predicted.value() << " and " << measured.value() << ", z " << z(predicted, measured));
        CHECK(std::fabs(z(predicted, measured)) < 3.5);
        if (efforts != integrators::full_efforts) CHECK(std::fabs(z(planted, measured)) > 3.5);
    }
}

TEST_CASE("What a trial counts of paths is without their merges and connections", "[upbp]") {
    const TemporaryFolder folder;
    const auto scene = scene_from(box(grey, smoke_medium(folder.file("smoke.vol"))), edge);
    const RenderOptions options{.seed = 1, .width = edge, .height = edge};
    integrators::UpbpSettings settings;
    settings.radius = 0.3;
    const auto trial = [&] { return integrators::trial_of_efforts<true>(*scene, options, settings); };
    const integrators::Trial all = trial();
    settings.connections = settings.point_point = settings.point_beam = settings.beam_beam = false;
    const integrators::Trial few = trial();
    INFO(all.work_of_paths << " beside " << all.work.of_pass << ", " << few.work_of_paths << " beside "
                           << few.work.of_pass);
    CHECK(all.work.of_pass > 2.0 * few.work.of_pass);
    REQUIRE(few.work_of_paths > 0.0);
    // A trial errs by 1.0 % (24 seeds): three standard deviations of the difference of two.
    CHECK(all.work_of_paths == Approx(few.work_of_paths).epsilon(0.04));
}

TEST_CASE("Efforts change no mean", "[upbp][statistics]") {
    const auto scene = scene_from(box(grey, fog("0.6, 0.9, 1.2", "")), edge);
    integrators::UpbpSettings settings;
    settings.radius = 0.15;  // light and eye paths meet in every pass
    settings.limits.max_depth = 4;
    const auto check = [&](const char* what) {
        INFO(what);
        const Mean full = light(*scene, settings, integrators::full_efforts, 1);
        const PerTechnique efforts{0.3, 0.2, 0.1, 0.25, 0.15};
        const Mean seldom = light(*scene, settings, efforts, 2);
        INFO(full.value() << " and " << seldom.value() << ", z " << z(full, seldom));
        CHECK(std::fabs(z(full, seldom)) < 3.5);
        // Planted: all is always sought, but weighted as if it were not.
        const Mean forgotten = light(*scene, settings, efforts, 2, true);
        INFO(forgotten.value() << " where that is forgotten, z " << z(full, forgotten));
        CHECK(std::fabs(z(full, forgotten)) > 3.5);
        Mean planted = seldom;  // a forgotten effort is a factor of three or more in what merges bring
        planted.sum *= 0.8, planted.squares *= 0.8 * 0.8;
        CHECK(std::fabs(z(full, planted)) > 3.5);
    };
    settings.connections = false;
    check("merges alone");
    settings.heuristic = integrators::Heuristic::none;
    check("each merge in full");
    settings.connections = true, settings.heuristic = integrators::Heuristic::balance;
    // Connections have no kernel's bias and take over some light: at 0.15 this alone is 3 % of the mean, at
    // 0.04 less than 1 %, and without a radius both means are 0.760 (20000 passes).
    settings.radius = 0.04;
    check("connections too");
    settings.surface = settings.point_point = settings.point_beam = settings.beam_beam = false;
    settings.heuristic = integrators::Heuristic::none;
    check("connections alone, each in full");
}

TEST_CASE("Crowded kernels are sought less often", "[upbp]") {
    const auto scene = scene_from(box(grey, fog("3", "")), 32);
    const RenderOptions options{.seed = 1, .width = 32, .height = 32};
    integrators::UpbpSettings settings;
    settings.radius = 0.5;
    const PerTechnique efforts =
        integrators::efficient_efforts(integrators::trial_of_efforts<true>(*scene, options, settings));
    for (const double effort : efforts) CHECK((effort >= 1.0 / 64.0 && effort <= 1.0));
    CHECK((efforts[2] <= 0.25 && efforts[3] <= 0.25));
}
