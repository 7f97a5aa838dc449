// The driver: stop rules, interruption, progress, and refusals.
#include <tbb/global_control.h>

#include <chrono>
#include <thread>

#include "core/objects/error.h"
#include "core/objects/memory_error.h"
#include "core/render/stop_clock.h"
#include "tests/core/render/fake_render.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

using namespace mote::core;
using namespace mote::tests;

TEST_CASE("Passes run in index order, as many as requested", "[driver]") {
    const auto scene = fake_scene();
    std::vector<std::uint32_t> seen;
    const CountingIntegrator integrator([&](std::uint32_t index) { seen.push_back(index); });
    const RenderResult result = render(*scene, integrator, request_for(5));
    CHECK(seen == std::vector<std::uint32_t>{0, 1, 2, 3, 4});
    CHECK(result.film.pass_count() == 5);
    CHECK_FALSE(result.interrupted);
    CHECK(result.film.mean(0)[0] == Rgb(7.0f));  // finish() was called

    RenderRequest by_scene;  // no rule: what the film requests
    CHECK(render(*scene, CountingIntegrator(), by_scene).film.pass_count() == 20);
}

TEST_CASE("A film beyond the budget is refused before the first pass", "[driver][memory]") {
    const auto scene = fake_scene(2000, 1000);
    int passes = 0;
    const CountingIntegrator integrator([&](std::uint32_t) { ++passes; });
    RenderRequest request = request_for(1);
    request.memory = MemoryBudget(1e6);
    CHECK_THROWS_AS(render(*scene, integrator, request), OutOfMemory);
    CHECK(passes == 0);
    request.memory = MemoryBudget(1e9);
    CHECK(render(*scene, integrator, request).film.pass_count() == 1);
}

TEST_CASE("Another seed gives another picture, another number of threads the same", "[driver]") {
    const auto scene = fake_scene();
    const auto one = [&] {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
        return bits(render(*scene, CountingIntegrator(), request_for(18)));
    }();
    CHECK(bits(render(*scene, CountingIntegrator(), request_for(18))) == one);
    RenderRequest other = request_for(18);
    other.seed = 10;
    CHECK(bits(render(*scene, CountingIntegrator(), other)) != one);
}

TEST_CASE("The noise rule stops where the noise is below it, whatever the number of threads", "[driver]") {
    const auto scene = fake_scene();
    RenderRequest request;
    // Uniform noise of half-width 0.5 and mean near 1.4, of one dimension a layer: the mean of n = 2^k Sobol
    // points has the standard deviation 1/sqrt(12 n^3) in each, which is 0.9 % of the mean at 8.
    request.stop.noise = 0.004;
    const RenderResult result = render(*scene, CountingIntegrator(), request);
    CHECK(result.film.noise() <= 0.004);
    CHECK(result.film.pass_count() > noise_rule_from);
    RenderRequest one_less = request_for(result.film.pass_count() - 1);
    one_less.seed = 0;
    CHECK(render(*scene, CountingIntegrator(), one_less).film.noise() > 0.004);
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    CHECK(render(*scene, CountingIntegrator(), request).film.pass_count() == result.film.pass_count());
}

TEST_CASE("Stop rules", "[driver]") {
    RenderState s;
    s.passes = 10, s.passes_of_this_run = 4, s.seconds = 4.0, s.noise = 0.1;
    CHECK(must_stop({10, {}, {}}, s));
    CHECK_FALSE(must_stop({11, {}, {}}, s));
    CHECK(must_stop({{}, 4.4, {}}, s));        // a fifth pass would end at 5 s
    CHECK_FALSE(must_stop({{}, 4.6, {}}, s));  // nearer to it than 4 s
    s.seconds_to_finish = 0.3;                 // four passes end at 4.3 s, five at 5.3 s
    CHECK(must_stop({{}, 4.6, {}}, s));
    CHECK_FALSE(must_stop({{}, 4.9, {}}, s));
    s.seconds_to_finish = 0.0;
    s.seconds_of_previews = 2.0;  // a fifth pass would end at 4.5 s
    CHECK(must_stop({{}, 4.2, {}}, s));
    CHECK_FALSE(must_stop({{}, 4.3, {}}, s));
    s.seconds_of_previews = 0.0;
    CHECK(must_stop({{}, {}, 0.1}, s));
    CHECK_FALSE(must_stop({{}, {}, 0.09}, s));
    CHECK(must_stop({100, 4.0, 0.01}, s));                   // the first that holds
    CHECK_FALSE(must_stop({{}, 0.001, {}}, RenderState{}));  // one pass at least
    s.seconds_beside = 0.5;                                  // of loading and building
    CHECK(must_stop({{}, 4.9, {}}, s));
    CHECK_FALSE(must_stop({{}, 5.1, {}}, s));
    s.seconds_beside = 0.0,
    s.seconds = 40.0;  // long passes: another one would end at 50 s, a second late at most
    CHECK(must_stop({{}, 48.9, {}}, s));
    CHECK_FALSE(must_stop({{}, 49.1, {}}, s));
    s.seconds = 4.0;
    s.passes = 7;
    CHECK_FALSE(must_stop({{}, {}, 0.5}, s));  // too few for the noise

    s.passes = 10;
    CHECK(seconds_left({30, {}, {}}, s) == Approx(20.0));
    CHECK(seconds_left({30, 7.0, {}}, s) == Approx(3.0));
    CHECK(seconds_left({{}, {}, 0.05}, s) == Approx(30.0));  // four times the passes for half the noise
    CHECK(seconds_left({{}, {}, {}}, s) < 0.0);
}

TEST_CASE("A time limit ends the render", "[driver]") {
    const auto scene = fake_scene(8, 8);
    RenderRequest request;
    request.stop.seconds = 0.05;
    request.progress = [](const RenderProgress&) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    };
    const RenderResult result = render(*scene, CountingIntegrator(), request);
    CHECK(result.film.pass_count() >= 1);
    CHECK(result.film.pass_count() <= 6);
}

TEST_CASE("Progress is reported after every pass", "[driver]") {
    const auto scene = fake_scene();
    std::vector<RenderProgress> seen;
    RenderRequest request = request_for(12);
    request.progress = [&](const RenderProgress& p) { seen.push_back(p); };
    render(*scene, CountingIntegrator(), request);
    REQUIRE(seen.size() == 12);
    CHECK(seen[3].passes == 4);
    CHECK(seen[3].passes_wanted == 12u);
    CHECK(seen[3].seconds_left > 0.0);
    CHECK(seen.back().seconds_left == 0.0);
    CHECK(std::isfinite(seen.back().noise));
}

TEST_CASE("Of a first pass that is cut off, finished pixels are kept, and the others are marked",
          "[driver][checkpoint]") {
    const TemporaryFolder folder;
    const auto scene = fake_scene();
    std::atomic<bool> stop{false};
    CountingIntegrator cut_off;
    cut_off.at_pixel = [&](int x, int y) {  // within a tile, deep inside
        if (x < 20 || y != 10) return;
        stop = true;
        throw Cancelled();
    };
    RenderRequest request = request_for(3, folder.file("c"));
    request.interrupted = &stop;
    CHECK(render(*scene, cut_off, request).film.pass_count() == 0);  // only whole passes, unless requested

    stop = false, request.keep_part_of_first_pass = true;
    const RenderResult part = render(*scene, cut_off, request),
                       whole = render(*scene, CountingIntegrator(), request_for(1));
    CHECK(part.interrupted);
    CHECK(folder.size() == 0);  // no checkpoint: to resume is to begin
    REQUIRE(part.finished_pixels.size() == part.film.pixels());
    std::size_t kept = 0;
    for (std::size_t i = 0; i < part.film.pixels(); ++i)
        for (std::size_t layer = 1; layer < 3; ++layer) {  // of layer 0 finish() changes the mean
            kept += part.finished_pixels[i];
            CHECK(part.film.mean(layer)[i] ==
                  (part.finished_pixels[i] ? whole.film.mean(layer)[i] : Rgb(0.0f)));
        }
    CHECK(kept > 0);
    CHECK(kept < 2 * part.film.pixels());

    // The time is no interruption. In later passes what is complete is the picture.
    std::atomic<bool> over{true};
    stop = false, request.time_is_over = &over;
    CHECK_FALSE(render(*scene, cut_off, request).interrupted);
    std::uint32_t pass = 0;
    CountingIntegrator later([&](std::uint32_t index) { pass = index; });
    later.at_pixel = [&](int x, int) {
        if (pass == 2 && x == 20) stop = true;
    };
    stop = false, over = false;
    const RenderResult two = render(*scene, later, request);
    CHECK(two.finished_pixels.empty());
    CHECK(bits(two) == bits(render(*scene, CountingIntegrator(), request_for(2))));
}

TEST_CASE("Layers that have no pass when the time is over are named", "[driver]") {
    std::atomic<bool> stop{false}, over{false};
    class TwoParts final : public Integrator {
      public:
        explicit TwoParts(std::atomic<bool>& end) : end_(end) {}
        std::string type() const override { return "two_parts"; }
        std::vector<Layer> layers(const Scene&) const override {
            Layer near{"direct", ""}, far{"indirect", ""}, fog{"single_scattering", ""};
            far.part = fog.part = 1;
            return {near, far, fog};
        }
        Plan plan(const Scene&, const Requirements&) const override { return {}; }
        std::unique_ptr<Estimator> prepare(const Scene&, const RenderOptions&) const override {
            class Passes final : public Estimator {
              public:
                explicit Passes(std::atomic<bool>& end) : end_(end) {}
                std::size_t next_part(const Film& film) const override { return film.pass_count(0) > 0; }
                std::size_t part_of_pass(std::uint32_t number) const override { return number % 2; }
                bool pass(const PassContext& context, PassImage&) override {
                    return context.part == 0 || !(end_ = true);  // the second part's pass ends in the middle
                }

              private:
                std::atomic<bool>& end_;
            };
            return std::make_unique<Passes>(end_);
        }

      private:
        std::atomic<bool>& end_;
    };
    RenderRequest request = request_for(4);
    request.interrupted = &stop, request.time_is_over = &over;
    over = true;
    const RenderResult late = render(*fake_scene(), TwoParts(stop), request);
    CHECK_FALSE(late.interrupted);
    REQUIRE_FALSE(late.statistics.warnings.empty());
    CHECK_THAT(late.statistics.warnings.back(),
               Catch::Matchers::EndsWith("lacks indirect, single_scattering"));
    over = stop = false;  // Ctrl-C: the caller names them, where it reports the interruption
    const RenderResult cut = render(*fake_scene(), TwoParts(stop), request);
    CHECK(cut.interrupted);
    CHECK(cut.statistics.warnings.empty());
}

TEST_CASE("Work that was cancelled while building ends the render", "[driver]") {
    class Slow final : public Integrator {
      public:
        std::string type() const override { return "slow"; }
        std::vector<Layer> layers(const Scene&) const override { return {{"direct", "", false}}; }
        Plan plan(const Scene&, const Requirements&) const override { return {}; }
        std::unique_ptr<Estimator> prepare(const Scene&, const RenderOptions& options) const override {
            for (;;) options.cancelled.check();
        }
    };
    const std::atomic<bool> stop{true};
    RenderRequest request = request_for(1);
    request.interrupted = &stop;
    const RenderResult result = render(*fake_scene(), Slow(), request);
    CHECK(result.interrupted);
    CHECK(result.film.pass_count() == 0);
}

TEST_CASE("Exceptions of a tile reach the caller", "[driver]") {
    const std::atomic<bool> never{false};
    CHECK_THROWS_AS(for_each_tile(64, 64, 8, never,
                                  [](int x0, int, int, int) {
                                      if (x0 == 32) throw InputError("here");
                                  }),
                    InputError);
}

TEST_CASE("Tiles cover every pixel once, and stop when cancelled", "[driver]") {
    std::atomic<bool> cancelled{false};
    for (const auto& [w, h, tile] : {std::tuple(17, 9, 8), std::tuple(1, 1, 16), std::tuple(1, 65535, 16)}) {
        std::vector<std::atomic<int>> hits(std::size_t(w) * std::size_t(h));
        CHECK(for_each_tile(w, h, tile, cancelled, [&, w = w](int x0, int y0, int x1, int y1) {
            for (int y = y0; y < y1; ++y)
                for (int x = x0; x < x1; ++x) ++hits[std::size_t(y) * std::size_t(w) + std::size_t(x)];
        }));
        bool once = true;
        for (const auto& n : hits) once = once && n == 1;
        CHECK(once);
    }
    std::atomic<int> tiles{0};
    CHECK_FALSE(
        for_each_tile(512, 512, 8, cancelled, [&](int, int, int, int) { ++tiles, cancelled = true; }));
    CHECK(tiles < 64 * 64);
}

TEST_CASE("A plan as text holds every entry with its reason", "[plan]") {
    Plan plan;
    plan.integrator = "fake";
    plan.run("transmittance", "analytic", "every medium is homogeneous");
    plan.leave_out("textures", "none", "there are none");
    const std::string text = plan.to_text();
    CHECK(text.find("fake") != std::string::npos);
    CHECK(text.find("transmittance  analytic  every medium is homogeneous") != std::string::npos);
    CHECK(text.find("there are none") != std::string::npos);
    CHECK(text.find("missing") == std::string::npos);
    plan.miss("caustics", "", "delta");
    CHECK(plan.to_text().find("missing") != std::string::npos);
}
