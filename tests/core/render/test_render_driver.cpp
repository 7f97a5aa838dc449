// The driver: stop rules, interruption, checkpoints that resume to the very same bits, and refusals.
#include <tbb/global_control.h>

#include <chrono>
#include <fstream>
#include <set>
#include <thread>

#include "core/objects/error.h"
#include "core/objects/memory_error.h"
#include "core/render/checkpoint.h"
#include "core/render/stop_clock.h"
#include "tests/core/render/fake_render.h"
#include "tests/support/catch.h"
#include "tests/support/integrator_of.h"
#include "tests/support/temporary_folder.h"

using namespace mote::core;
using namespace mote::tests;

namespace {

RenderRequest request_for(std::uint32_t passes, const std::string& checkpoint = "") {
    RenderRequest request;
    request.seed = 9;
    request.stop.passes = passes;
    request.checkpoint_path = checkpoint;
    request.content_hash = "0123456789abcdef";
    return request;
}

std::vector<std::byte> bits(const RenderResult& result) { return result.film.serialize(); }

std::string read_text(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}
void write_text(const std::string& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

// Renders until `last` passes are done, then is interrupted in the middle of the next.
RenderResult interrupted_render(const Scene& scene, RenderRequest request, std::uint32_t last) {
    std::atomic<bool> flag{false};
    const CountingIntegrator integrator([&](std::uint32_t index) {
        if (index == last) flag = true;
    });
    request.interrupted = &flag;
    return render(scene, integrator, request);
}

}  // namespace

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

TEST_CASE("A checkpoint beyond the budget is not begun", "[driver][memory]") {
    const TemporaryFolder folder;
    const auto scene = fake_scene(200, 100);
    const CountingIntegrator integrator;
    const RenderResult whole = render(*scene, integrator, request_for(2));
    const std::string path = folder.file("checkpoint");
    CHECK_THROWS_AS(write_checkpoint(path, {"0123456789abcdef", 9}, whole.film, MemoryBudget(1000.0)),
                    OutOfMemory);
    CHECK(folder.size() == 0);
    CHECK_NOTHROW(write_checkpoint(path, {"0123456789abcdef", 9}, whole.film, MemoryBudget(1e9)));
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

TEST_CASE("An interrupted render drops the running pass and keeps the rest", "[driver][checkpoint]") {
    const TemporaryFolder folder;
    const auto scene = fake_scene();
    const RenderResult cut = interrupted_render(*scene, request_for(30, folder.file("c")), 19);
    CHECK(cut.interrupted);
    CHECK(cut.film.pass_count() == 19);
    CHECK(cut.film.mean(0)[0] == Rgb(7.0f));  // finish() was called nonetheless
    CHECK_FALSE(cut.finished_for);
    CHECK(bits(cut) == bits(render(*scene, CountingIntegrator(), request_for(19))));
    CHECK(folder.size() == 1);
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

TEST_CASE("Interrupted and resumed gives the bits of one run", "[driver][checkpoint]") {
    const TemporaryFolder folder;
    const auto scene = fake_scene();
    const auto whole = bits(render(*scene, CountingIntegrator(), request_for(50)));
    for (const std::uint32_t first : {1u, 15u, 16u, 17u, 33u}) {
        interrupted_render(*scene, request_for(50, folder.file("c")), first);
        RenderRequest again = request_for(50, folder.file("c"));
        again.resume = true;
        interrupted_render(*scene, again, first + 9);  // and once more
        const RenderResult resumed = render(*scene, CountingIntegrator(), again);
        CHECK(resumed.resumed_at == first + 9);
        CHECK(bits(resumed) == whole);
    }
    // A complete checkpoint has nothing left to do, or can be taken further.
    RenderRequest more = request_for(60, folder.file("c"));
    more.resume = true;
    CHECK(bits(render(*scene, CountingIntegrator(), more)) ==
          bits(render(*scene, CountingIntegrator(), request_for(60))));
}

TEST_CASE("Checkpoints are written on the way, and a killed render continues from the last",
          "[driver][checkpoint]") {
    const TemporaryFolder folder;
    const auto scene = fake_scene();
    RenderRequest request = request_for(40, folder.file("c"));
    request.checkpoint_every_seconds = 0.0;
    const CountingIntegrator dying([](std::uint32_t index) {
        if (index == 23) throw std::runtime_error("killed");
    });
    CHECK_THROWS_AS(render(*scene, dying, request), std::runtime_error);
    request.resume = true;
    const RenderResult resumed = render(*scene, CountingIntegrator(), request);
    CHECK(resumed.resumed_at == 23);
    CHECK(bits(resumed) == bits(render(*scene, CountingIntegrator(), request_for(40))));
}

TEST_CASE("Resuming without a checkpoint starts anew, with a warning", "[driver][checkpoint]") {
    const TemporaryFolder folder;
    const auto scene = fake_scene();
    RenderRequest request = request_for(3, folder.file("c"));
    request.resume = true;
    const RenderResult result = render(*scene, CountingIntegrator(), request);
    CHECK(result.film.pass_count() == 3);
    CHECK(result.statistics.warnings.size() == 1);
}

TEST_CASE("A checkpoint of another render is refused", "[driver][checkpoint]") {
    const TemporaryFolder folder;
    const auto scene = fake_scene();
    const RenderRequest good = [&] {
        RenderRequest request = request_for(8, folder.file("c"));
        render(*scene, CountingIntegrator(), request);
        request.resume = true;
        request.stop.passes = 9;
        return request;
    }();
    const auto refused = [&](const RenderRequest& request, const Integrator& integrator, const Scene& in,
                             const std::string& reason) {
        try {
            render(in, integrator, request);
        } catch (const InputError& error) {
            const std::string message = error.what();
            INFO(message);
            CHECK(message.find(folder.file("c")) == 0);
            return message.find(reason) != std::string::npos;
        }
        return false;
    };
    RenderRequest other = good;
    other.seed = 1;
    CHECK(refused(other, CountingIntegrator(), *scene, "seed"));
    other = good;
    other.content_hash = "fedcba9876543210";
    CHECK(refused(other, CountingIntegrator(), *scene, "changed"));
    CHECK(refused(good, CountingIntegrator(), *fake_scene(21, 37), "picture"));
    CHECK(refused(good, CountingIntegrator({}, "multiple"), *scene, "layers"));
    CHECK(render(*scene, CountingIntegrator(), good).resumed_at == 8);
}

TEST_CASE("Every damage to a checkpoint is refused", "[driver][checkpoint]") {
    const TemporaryFolder folder;
    const auto scene = fake_scene(3, 2);
    RenderRequest request = request_for(5, folder.file("c"));
    render(*scene, CountingIntegrator(), request);
    request.resume = true;
    const std::string good = read_text(folder.file("c"));
    REQUIRE(good.size() > 500);
    std::size_t tried = 0;
    for (std::size_t i = 0; i < good.size(); i += i < 200 ? 1 : 7, ++tried) {
        std::string bad = good;
        bad[i] = char(bad[i] ^ (1 << (i % 8)));
        write_text(folder.file("c"), bad);
        REQUIRE_THROWS_AS(render(*scene, CountingIntegrator(), request), InputError);
        write_text(folder.file("c"), good.substr(0, i));
        REQUIRE_THROWS_AS(render(*scene, CountingIntegrator(), request), InputError);
    }
    write_text(folder.file("c"), good + "x");
    CHECK_THROWS_AS(render(*scene, CountingIntegrator(), request), InputError);
    CHECK(tried > 250);
    write_text(folder.file("c"), good);
    CHECK(render(*scene, CountingIntegrator(), request).resumed_at == 5);
}

TEST_CASE("A checkpoint that cannot be written is a warning and another try", "[driver][checkpoint]") {
    const TemporaryFolder folder;
    const auto scene = fake_scene();
    write_text(folder.file("plain"), "file");
    const std::string path = folder.file("plain/c");
    const RenderResult result = render(*scene, CountingIntegrator(), request_for(2, path));
    CHECK(result.film.pass_count() == 2);
    REQUIRE(result.statistics.warnings.size() == 1);
    CHECK(result.statistics.warnings[0].find(path) != std::string::npos);
    // A file that is no checkpoint is refused before the first pass.
    CHECK_THROWS_AS(render(*scene, CountingIntegrator(), request_for(2, "/dev/full")), InputError);
    CHECK_THROWS_AS(render(*scene, CountingIntegrator(), request_for(2, folder.file("plain"))), InputError);
    // There is room again after the second pass.
    int failed = 0;
    RenderRequest request = request_for(4, folder.file("later/c"));
    request.checkpoint_every_seconds = 0.0;
    request.checkpoint_failed = [&](const std::string&) { ++failed; };
    const CountingIntegrator makes_room([&](std::uint32_t index) {
        if (index == 2) std::filesystem::create_directory(folder.file("later"));
    });
    CHECK(render(*scene, makes_room, request).statistics.warnings.empty());
    CHECK(failed == 2);
    RenderRequest more = request_for(4, folder.file("later/c"));
    more.resume = true;
    CHECK(render(*scene, CountingIntegrator(), more).resumed_at == 4);
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

TEST_CASE("The content hash changes with every byte of every file and every setting, not with names",
          "[driver]") {
    const TemporaryFolder folder;
    write_text(folder.file("a"), "scene");
    write_text(folder.file("b"), "grid");
    const auto hash = [&](std::vector<std::string> files, std::vector<std::string> settings) {
        for (auto& f : files) f = folder.file(f);
        return content_hash(*fake_scene(4, 4, files), settings);
    };
    const std::string h = hash({"a", "b"}, {"x=1"});
    CHECK(h.size() == 16);
    CHECK(hash({"a", "b"}, {"x=1"}) == h);
    CHECK(hash({"a", "b"}, {"x=2"}) != h);
    CHECK(hash({"a", "b"}, {"x=", "1"}) != h);
    CHECK(hash({"b", "a"}, {"x=1"}) != h);
    write_text(folder.file("renamed"), "grid");
    CHECK(hash({"a", "renamed"}, {"x=1"}) == h);
    write_text(folder.file("b"), "grie");
    CHECK(hash({"a", "b"}, {"x=1"}) != h);
    write_text(folder.file("b"), "");
    write_text(folder.file("a"), "scenegrid");
    CHECK(hash({"a", "b"}, {"x=1"}) != h);
    CHECK_THROWS_AS(hash({"missing"}, {}), InputError);
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

namespace {

/// Callback in finish(), which may throw.
using InFinish = std::function<void(const Film&, CancelToken)>;

/// One that finishes its picture with sevens, and notes what the film says when the next pass is chosen.
class FinishingEstimator final : public Estimator {
  public:
    explicit FinishingEstimator(std::vector<float>& seen, InFinish in_finish = {})
        : seen_(seen), in_finish_(std::move(in_finish)) {}
    bool pass(const PassContext&, PassImage& image) override {
        for (Rgb& pixel : image.layer(0)) pixel = Rgb(1.0f);
        return true;
    }
    std::size_t next_part(const Film& film) const override {
        seen_.push_back(film.mean(0)[0].x);
        return 0;
    }
    void finish(Film& film, CancelToken cancelled) override {
        film.set_mean(0, std::vector<Rgb>(film.pixels(), Rgb(7.0f)));
        if (in_finish_) in_finish_(film, cancelled);
    }

  private:
    std::vector<float>& seen_;
    InFinish in_finish_;
};
using FinishingIntegrator = IntegratorOf<FinishingEstimator>;

}  // namespace

TEST_CASE("a preview shows the finished picture and leaves the film as it was", "[driver]") {
    const auto scene = fake_scene();
    std::vector<float> seen;
    std::vector<float> shown;
    RenderRequest request = request_for(3);
    request.preview = [&](const Film& film, const auto&) { shown.push_back(film.mean(0)[0].x); };
    const RenderResult result = render(*scene, FinishingIntegrator(seen), request);
    REQUIRE_FALSE(shown.empty());
    CHECK(shown.front() == 7.0f);
    CHECK(seen == std::vector<float>{0.0f, 1.0f, 1.0f});
    CHECK(result.film.mean(0)[0].x == 7.0f);
}

namespace {

/// Says how long it took to find what later calls find already, whatever it took.
class OnceEstimator final : public Estimator {
  public:
    explicit OnceEstimator(double seconds) : seconds_(seconds) {}
    bool pass(const PassContext&, PassImage&) override { return true; }
    void finish(Film&, CancelToken) override { found_ = true; }
    double seconds_once() const override { return found_ ? seconds_ : 0.0; }

  private:
    double seconds_;
    bool found_ = false;
};
using OnceIntegrator = IntegratorOf<OnceEstimator>;

}  // namespace

TEST_CASE("Time for what a preview finds for all later ones does not put those off", "[driver]") {
    const auto scene = fake_scene();
    int shown = 0;
    RenderRequest request = request_for(20);
    request.preview = [&](const Film&, const auto&) { ++shown; };
    request.preview_every_seconds = 0.0, request.preview_share = 1e-12;  // the next one in a million seconds
    render(*scene, OnceIntegrator(0.0), request);
    CHECK(shown == 1);
    shown = 0;
    render(*scene, OnceIntegrator(1e6), request);
    CHECK(shown == 2);
}

TEST_CASE("a quick look is not finished: the first preview, or the whole picture", "[driver]") {
    const auto scene = fake_scene();
    std::vector<float> seen, shown;
    RenderRequest request = request_for(3);
    request.preview = [&](const Film& film, const auto&) { shown.push_back(film.mean(0)[0].x); };
    request.preview_every_seconds = 0.0, request.preview_share = 1e9;
    request.first_preview_is_raw = true;
    CHECK(render(*scene, FinishingIntegrator(seen), request).film.mean(0)[0].x == 7.0f);
    CHECK(shown == std::vector<float>{1.0f, 7.0f});
    request.finish = false;
    CHECK(render(*scene, FinishingIntegrator(seen), request).film.mean(0)[0].x == 1.0f);
}

TEST_CASE("a picture that a preview has finished is not finished again", "[driver]") {
    const auto scene = fake_scene();
    std::vector<float> seen;
    int finishes = 0;
    RenderRequest request = request_for(1000);
    request.stop.seconds = 0.05;  // over after the preview of the first pass
    request.preview = [](const Film&, const auto&) {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    };
    const InFinish count = [&](const Film&, CancelToken) { ++finishes; };
    const RenderResult result = render(*scene, FinishingIntegrator(seen, count), request);
    CHECK(result.film.pass_count() == 1);
    CHECK(finishes == 1);
    CHECK(result.film.mean(0)[0].x == 7.0f);
}

namespace {

/// Its finish() would take for ever after another pass, unless it is shortened.
class LongFinishEstimator final : public Estimator {
  public:
    explicit LongFinishEstimator(bool can_be_shorter) : can_be_shorter_(can_be_shorter) {}
    bool pass(const PassContext&, PassImage&) override { return true; }
    std::optional<double> seconds_to_finish(const Film&) const override { return shorter_ ? 0.0 : 1e9; }
    void shorten_finish(const Film&) override { shorter_ = can_be_shorter_; }

  private:
    bool can_be_shorter_, shorter_ = false;
};
using LongFinish = IntegratorOf<LongFinishEstimator>;

}  // namespace

TEST_CASE("Time that is left, but not for what finish() would do after more passes, is used for passes",
          "[driver]") {
    const auto scene = fake_scene();
    RenderRequest request = request_for(5);
    request.stop.seconds = 1e6;
    request.preview = [](const Film&, const auto&) {};
    CHECK(render(*scene, LongFinish(false), request).film.pass_count() == 1);
    CHECK(render(*scene, LongFinish(true), request).film.pass_count() == 5);
}

TEST_CASE("an interrupted render has the finished picture where that is quick, and else the last preview's",
          "[driver][stopping]") {
    const auto scene = fake_scene();
    std::vector<float> seen;
    std::atomic<bool> stop{false};
    const TemporaryFolder folder;
    RenderRequest request = request_for(9, folder.file("c"));
    request.interrupted = &stop;
    request.progress = [&](const RenderProgress& p) { stop = p.passes == 4; };
    const auto mean = [](const RenderResult& result) { return result.film.mean(0)[0].x; };

    const RenderResult quick = render(*scene, FinishingIntegrator(seen), request);
    CHECK(quick.interrupted);
    CHECK(mean(quick) == 7.0f);
    CHECK_FALSE(quick.finished_for);

    // Previews have their time, the end has a second: what was half done is left out, and said.
    const InFinish slow = [&](const Film&, CancelToken cancelled) {
        while (stop) cancelled.check();
    };
    const auto start = std::chrono::steady_clock::now();
    stop = false;
    const RenderResult without = render(*scene, FinishingIntegrator(seen, slow), request);
    CHECK(without.finished_for == 0u);
    CHECK(mean(without) == 1.0f);
    stop = false, request.preview = [](const Film&, const auto&) {};  // after the first pass
    const RenderResult with = render(*scene, FinishingIntegrator(seen, slow), request);
    CHECK(with.finished_for == 1u);
    CHECK(mean(with) == 7.0f);
    CHECK(with.film.pass_count() == 4);
    CHECK(bits(with) == bits(quick));
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(20));  // two, on a quiet machine

    // It continues from there, and is finished in the end.
    stop = false, request.progress = {}, request.resume = true;
    const RenderResult resumed = render(*scene, FinishingIntegrator(seen, slow), request);
    CHECK(resumed.resumed_at == 4);
    CHECK(mean(resumed) == 7.0f);
    CHECK_FALSE(resumed.finished_for);
}

TEST_CASE("a render that is interrupted while its picture is finished is finished in a hurry",
          "[driver][stopping]") {
    const auto scene = fake_scene();
    std::vector<float> seen;
    std::atomic<bool> stop{false};
    const TemporaryFolder folder;
    RenderRequest request = request_for(2, folder.file("c"));
    request.interrupted = &stop, request.checkpoint_at_end = false;
    int calls = 0;
    const RenderResult result = render(*scene,
                                       FinishingIntegrator(seen,
                                                           [&](const Film&, CancelToken cancelled) {
                                                               stop = true, ++calls;
                                                               cancelled.check();
                                                           }),
                                       request);
    CHECK(result.interrupted);
    CHECK(calls == 2);
    CHECK(result.film.mean(0)[0].x == 7.0f);
    CHECK_FALSE(result.finished_for);
    CHECK(folder.size() == 1);  // the checkpoint
}

namespace {

/// Noise in one layer, of which a hundredth of the variance is left when it is finished.
class FilteringIntegrator final : public Integrator {
  public:
    std::string type() const override { return "filtering"; }
    std::vector<Layer> layers(const Scene&) const override { return {{"direct", "", false, true}}; }
    Plan plan(const Scene&, const Requirements&) const override { return {}; }
    std::unique_ptr<Estimator> prepare(const Scene&, const RenderOptions&) const override {
        return std::make_unique<Pass>();
    }

  private:
    class Pass final : public Estimator {
      public:
        bool pass(const PassContext& context, PassImage& image) override {
            std::uint64_t i = 0;
            for (Rgb& pixel : image.layer(0))
                pixel = Rgb(0.5f + Sampler(SamplerKind::independent, 1, context.index, i++).next_1d());
            return true;
        }
        void finish(Film& film, CancelToken) override {
            std::vector<float> left;
            for (const Rgb& v : film.layer_variance_of_mean(0)) left.push_back(0.01f * average(v));
            film.set_mean(0, std::vector<Rgb>(film.pixels(), Rgb(1.0f)), left);
        }
        bool changes_noise(const Film&) const override { return true; }
    };
};

}  // namespace

TEST_CASE("the noise that is stated is that of the finished picture", "[driver][noise]") {
    const auto scene = fake_scene();
    // Standard deviation 1/sqrt(12) and mean 1: after n passes 0.289 / sqrt(n), of which a tenth is left. The
    // gain of Sobol points, 1 here, is known from one difference of halves in each of 777 pixels at the
    // least: its standard error is sqrt(2 / 777), half of that for the noise.
    const auto expected = [](std::uint32_t n) { return 0.1 / std::sqrt(12.0 * n); };
    const double within = 5.0 * 0.5 * std::sqrt(2.0 / 777.0);
    std::vector<double> reported;
    RenderRequest request = request_for(20);
    request.progress = [&](const RenderProgress& p) { reported.push_back(p.noise); };
    const RenderResult result = render(*scene, FilteringIntegrator(), request);
    CHECK(result.film.noise() == Approx(expected(20)).epsilon(within));
    CHECK(result.statistics.values.at("noise") == result.film.noise());
    Film passes = result.film;
    passes.exchange_replaced();
    CHECK(passes.noise() == Approx(10.0 * expected(20)).epsilon(within));
    // The noise of the passes is not reported, and what is reported does not wait for a preview that is
    // shown.
    REQUIRE(reported.size() == 20);
    for (std::uint32_t i = 1; i < 20; ++i)
        CHECK((std::isinf(reported[i]) || reported[i] < 0.5 * 10.0 * expected(i + 1)));

    // The rule evaluates it after 8, 10, 12, 14, 16, 20, 24, ... passes, whatever else evaluates it.
    RenderRequest rule = request_for(1000);
    const TemporaryFolder folder;
    rule.stop = {{}, {}, expected(31), {}};
    const RenderResult straight = render(*scene, FilteringIntegrator(), rule);
    const std::uint32_t passes_of_rule = straight.film.pass_count();
    CHECK(straight.film.noise() <= *rule.stop.noise);
    const std::set<std::uint32_t> looks{20, 24, 28, 32, 40};  // within those 13 %
    CHECK(looks.contains(passes_of_rule));
    CHECK(render(*scene, FilteringIntegrator(), request_for(passes_of_rule - 1)).film.noise() >
          0.9 * *rule.stop.noise);
    rule.preview = [](const Film&, const auto&) {};
    CHECK(bits(render(*scene, FilteringIntegrator(), rule)) == bits(straight));
    rule.checkpoint_path = folder.file("c");
    std::atomic<bool> stop{false};
    rule.interrupted = &stop;
    rule.progress = [&](const RenderProgress& p) { stop = p.passes == 21; };
    REQUIRE(render(*scene, FilteringIntegrator(), rule).interrupted);
    stop = false, rule.progress = {}, rule.resume = true;
    CHECK(bits(render(*scene, FilteringIntegrator(), rule)) == bits(straight));
}
