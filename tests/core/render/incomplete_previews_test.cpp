// Previews of a picture some of whose parts have no pass yet.
#include <chrono>
#include <cmath>
#include <thread>

#include "core/render/render_driver.h"
#include "tests/core/render/fake_render.h"
#include "tests/support/catch.h"
#include "tests/support/integrator_of.h"

using namespace mote::core;
using namespace mote::tests;

namespace {

/// Two parts of light 1; finish() doubles the first. Two passes of the first take 1.5 s each, the third is
/// one of the second.
class SlowEstimator final : public Estimator {
  public:
    static std::vector<Layer> layers() {
        std::vector<Layer> layers = {{"direct", ""}, {"indirect", ""}};
        layers[1].part = 1;
        return layers;
    }
    bool pass(const PassContext& context, PassImage& image) override {
        if (context.part == 0 && context.index < 2)
            std::this_thread::sleep_for(std::chrono::milliseconds(1500));
        for (Rgb& c : image.layer(0)) c = Rgb(1.0f);
        return true;
    }
    std::size_t next_part(const Film& film) const override {
        return film.pass_count(0) >= 2 && film.pass_count(1) == 0;
    }
    void finish(Film& film, CancelToken) override {
        film.set_mean(0, std::vector<Rgb>(film.pixels(), Rgb(2.0f)));
    }
};
using SlowIntegrator = IntegratorOf<SlowEstimator>;

/// The light of each preview in the first pixel.
std::vector<float> previews(bool are_whole) {
    const auto scene = fake_scene();
    std::vector<float> shown;
    RenderRequest request;
    request.stop.passes = 4;
    request.preview = [&](const Film& film, const auto&) { shown.push_back(film.beauty()[0].x); };
    request.preview_every_seconds = 0.0, request.preview_share = 1e9;
    request.previews_are_whole = are_whole;
    render(*scene, SlowIntegrator(), request);
    return shown;
}

}  // namespace

TEST_CASE("A picture that lacks a part is shown after some seconds, as its passes are", "[driver][long]") {
    CHECK(previews(false) == std::vector<float>{1.0f, 3.0f});
}

TEST_CASE("Where previews are whole, none lacks a part", "[driver][long]") {
    CHECK(previews(true) == std::vector<float>{3.0f});
}
