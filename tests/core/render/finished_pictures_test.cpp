// Finished pictures of the driver: previews, interruptions, limits in time, and the noise.
#include <chrono>
#include <functional>
#include <set>
#include <thread>

#include "tests/core/render/fake_render.h"
#include "tests/support/catch.h"
#include "tests/support/integrator_of.h"
#include "tests/support/temporary_folder.h"

using namespace mote::core;
using namespace mote::tests;

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
class FilteringEstimator final : public Estimator {
  public:
    explicit FilteringEstimator(std::function<void()> in_finish = [] {}) : in_finish_(std::move(in_finish)) {}
    static std::vector<Layer> layers() { return {{"direct", "", false, true}}; }
    bool pass(const PassContext& context, PassImage& image) override {
        std::uint64_t i = 0;
        for (Rgb& pixel : image.layer(0))
            pixel = Rgb(0.5f + Sampler(SamplerKind::independent, 1, context.index, i++).next_1d());
        return true;
    }
    void finish(Film& film, CancelToken) override {
        in_finish_();
        std::vector<float> left;
        for (const Rgb& v : film.layer_variance_of_mean(0)) left.push_back(0.01f * average(v));
        film.set_mean(0, std::vector<Rgb>(film.pixels(), Rgb(1.0f)), left);
    }
    bool changes_noise(const Film&) const override { return true; }

  private:
    std::function<void()> in_finish_;
};
using FilteringIntegrator = IntegratorOf<FilteringEstimator>;

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
    // Known after half a second, by a preview before.
    RenderRequest slow = request_for(5);
    slow.progress = request.progress, reported.clear();
    slow.preview = [](const Film&, const auto&) {
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
    };
    slow.preview_every_seconds = 0.0, slow.preview_share = 1e9;
    render(*scene, FilteringIntegrator(), slow);
    CHECK(reported.back() == Approx(expected(5)).epsilon(within));
    // Where previews are not seen, no picture is finished for the reports either.
    const auto finishes = [&] {
        int count = 0;
        CHECK(render(*scene, FilteringIntegrator([&] { ++count; }), request).film.noise() ==
              result.film.noise());
        return count;
    };
    CHECK(finishes() > 1);
    request.preview_is_seen = [] { return false; };
    CHECK(finishes() == 1);

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
