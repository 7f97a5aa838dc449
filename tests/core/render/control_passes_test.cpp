// Control passes: which pixels they sample, how many there are, and that a render states an error by them.
#include "core/render/control_passes.h"

#include <cmath>
#include <set>

#include "core/render/pass_runner.h"
#include "tests/core/render/fake_render.h"
#include "tests/support/catch.h"

using namespace mote::core;
using namespace mote::tests;

namespace {

constexpr int width = 37, height = 21;  ///< of fake_scene()

/// A pixel's light is 1, with noise of its own; one ray a pixel is counted. Its passes record the corners of
/// their pixels in the film.
class UniformIntegrator final : public Integrator {
  public:
    using Corners = std::vector<std::pair<float, float>>;
    explicit UniformIntegrator(float light, std::uint64_t rays_per_pixel = 1,
                               std::shared_ptr<const Integrator> control = nullptr)
        : light_(light), rays_(rays_per_pixel), control_(std::move(control)) {}

    std::string type() const override { return "uniform"; }
    std::vector<Layer> layers(const Scene&) const override { return {{"direct", "", false}}; }
    Plan plan(const Scene&, const Requirements&) const override { return {}; }
    std::shared_ptr<const Integrator> control(const Scene&) const override { return control_; }
    std::unique_ptr<Estimator> prepare(const Scene&, const RenderOptions& options) const override {
        return std::make_unique<Uniform>(*this, options);
    }
    mutable std::vector<Corners> passes;

  private:
    class Uniform final : public Estimator {
      public:
        Uniform(const UniformIntegrator& of, const RenderOptions& options) : of_(of), options_(options) {}
        bool pass(const PassContext& context, PassImage& image) override {
            Corners corners;
            for (int y = 0; y < image.height(); ++y)
                for (int x = 0; x < image.width(); ++x) {
                    Sampler sampler(options_.sampler, options_.seed, context.index,
                                    std::uint64_t(y * image.width() + x));
                    image.at(0, x, y) = Rgb(of_.light_ * (0.5f + sampler.next_1d()));
                    const Vec2 corner = context.positions.corner(x, y);
                    corners.emplace_back(corner.x, corner.y);
                    image.finish(x, y), rays_ += of_.rays_;
                }
            of_.passes.push_back(std::move(corners));
            return true;
        }
        void add_statistics(Statistics& statistics) const override { statistics.rays["closest"] += rays_; }

      private:
        const UniformIntegrator& of_;
        RenderOptions options_;
        std::uint64_t rays_ = 0;
    };
    float light_;
    std::uint64_t rays_;
    std::shared_ptr<const Integrator> control_;
};

RenderRequest request_for(std::uint32_t passes, std::shared_ptr<const Integrator> control) {
    RenderRequest request;
    request.seed = 9, request.stop.passes = passes, request.control = std::move(control);
    return request;
}

}  // namespace

TEST_CASE("Control passes sample one pixel of each block of 4 x 2, the same in every pass", "[control]") {
    const auto scene = fake_scene(width, height);
    const UniformIntegrator unbiased(1.0f);
    ControlPasses control(*scene, unbiased, 9, {}, {});
    Film film(width, height, {{"direct", "", false}});
    PassImage image(width, height, 1);
    const std::atomic<bool> never{false};
    film.add_pass(image);
    control.follow(film, never);
    REQUIRE(unbiased.passes.size() == 2);  // two at least, whatever the image's passes took
    CHECK(unbiased.passes[0] == unbiased.passes[1]);
    std::set<std::pair<int, int>> blocks, places;
    for (const auto& [x, y] : unbiased.passes[0]) {
        REQUIRE((x >= 0.0f && x < float(width) && y >= 0.0f && y < float(height)));
        blocks.emplace(int(x) / 4, int(y) / 2), places.emplace(int(x) % 4, int(y) % 2);
        CHECK(x == std::floor(x));
    }
    CHECK(blocks.size() == 10 * 11);
    CHECK(unbiased.passes[0].size() == blocks.size());
    CHECK(places.size() == 8);  // all pixels of a block have their turn
    const UniformIntegrator other(1.0f);
    ControlPasses(*scene, other, 10, {}, {}).follow(film, never);
    CHECK(other.passes[0] != unbiased.passes[0]);
}

TEST_CASE("Control passes take a twentieth of the counted work, however it is interrupted", "[control]") {
    const auto scene = fake_scene(width, height);
    const std::atomic<bool> never{false};
    const auto passes_after = [&](const std::vector<double>& works) {
        const UniformIntegrator unbiased(1.0f);
        ControlPasses control(*scene, unbiased, 9, {}, {});
        Film film(width, height, {{"direct", "", false}});
        const PassImage image(width, height, 1);
        for (const double work : works) film.add_pass(image, 0, work), control.follow(film, never);
        return control.passes();
    };
    const double pass = 10.0 * 11.0;  // closest hits
    CHECK(passes_after({20.0 * 7.0 * pass}) == 7);
    CHECK(passes_after({20.0 * 3.0 * pass, 20.0 * 4.0 * pass}) == 7);
    CHECK(passes_after({20.0 * 7.9 * pass}) == 7);
    CHECK(passes_after({0.0}) == 2);
}

TEST_CASE("A render states its bias by control passes", "[control][driver]") {
    const auto scene = fake_scene(width, height);
    const auto unbiased = std::make_shared<const UniformIntegrator>(1.0f);
    const auto error = [&](float light) {
        const UniformIntegrator biased(light, 100);
        const RenderResult result = render(*scene, biased, request_for(64, unbiased));
        CHECK(result.statistics.values.at("control_passes") > 100.0);
        REQUIRE(result.error);
        return *result.error;
    };
    const PictureError right = error(1.0f), dark = error(0.8f);
    CHECK(right.high < 0.1);
    CHECK(dark.low > 0.18);
    CHECK(dark.high < 0.22);  // relative to the light, not to the image: else it were 0.25
    // Planted: a control that is as dark as the image finds no bias.
    const UniformIntegrator biased(0.8f, 100);
    CHECK(
        render(*scene, biased, request_for(64, std::make_shared<const UniformIntegrator>(0.8f))).error->high <
        0.1);
    // Without control passes, or in an image of few pixels, no error is stated.
    CHECK(!render(*scene, biased, request_for(64, nullptr)).error);
    CHECK(!render(*fake_scene(8, 8), biased, request_for(64, unbiased)).error);
}

TEST_CASE("A render resumed has the error of one run", "[control][driver][checkpoint]") {
    const auto scene = fake_scene(width, height);
    const auto unbiased = std::make_shared<const UniformIntegrator>(1.0f);
    const UniformIntegrator biased(0.8f, 100);
    const RenderResult whole = render(*scene, biased, request_for(13, unbiased));
    const RenderResult first = render(*scene, biased, request_for(6, unbiased));
    RenderRequest request = request_for(13, unbiased);
    request.begin_with = &first.film;
    const RenderResult rest = render(*scene, biased, request);
    CHECK(rest.film.serialize() == whole.film.serialize());
    REQUIRE(rest.error);
    CHECK(rest.error->high == whole.error->high);
    CHECK(rest.error->low == whole.error->low);
}
