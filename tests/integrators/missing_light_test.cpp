// The light that bounded VPLs leave out and the light that they find are together all light: by paths.
#include "integrators/virtual_point_lights/missing_light.h"

#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote::core;
using namespace mote::integrators;
using namespace mote::tests;

namespace {

/// `bounded` and, as a layer of its own, what it leaves out.
class BothParts final : public Integrator {
  public:
    BothParts(std::shared_ptr<const Integrator> bounded, float bound, int max_depth)
        : bounded_(std::move(bounded)), bound_(bound), max_depth_(max_depth) {}
    std::string type() const override { return "both parts"; }
    std::vector<Layer> layers(const Scene& scene) const override {
        std::vector<Layer> layers = bounded_->layers(scene);
        layers.push_back({.name = "missing", .description = "", .auxiliary = true});
        return layers;
    }
    Plan plan(const Scene&, const Requirements&) const override { return {}; }
    std::unique_ptr<Estimator> prepare(const Scene& scene, const RenderOptions& options) const override {
        if (scene.has_media()) return std::make_unique<Both<true>>(*this, scene, options);
        return std::make_unique<Both<false>>(*this, scene, options);
    }

  private:
    template <bool Media>
    struct Both final : Estimator {
        Both(const BothParts& parts, const Scene& scene, const RenderOptions& options)
            : left(parts.bounded_->prepare(scene, options)),
              missing(scene, options, {.max_depth = parts.max_depth_}, parts.bound_) {}
        bool pass(const PassContext& context, PassImage& image) override {
            return left->pass(context, image) && missing.pass(context, image, image.layers() - 1);
        }
        std::unique_ptr<Estimator> left;
        MissingLight<Media> missing;
    };
    std::shared_ptr<const Integrator> bounded_;
    float bound_;
    int max_depth_;
};

void check(const std::string& xml, float bound, std::uint32_t passes, int max_depth = -1) {
    const auto scene = scene_from(xml, 8);
    const std::string depth = fmt::format(R"(<integer name="max_depth" value="{}"/>)", max_depth);
    const auto bounded = integrator_from(fmt::format(
        R"(<integrator type="volpath"><float name="vpl_bound" value="{}"/>{}</integrator>)", bound, depth));
    std::vector<std::string> far = {"indirect"}, left = {"indirect_bounded"};
    if (scene->has_media())
        far.push_back("multiple_scattering"), left.push_back("multiple_scattering_bounded");
    std::vector<std::string> sum = left;
    sum.push_back("missing");
    const auto parts = render_statistics(*scene, BothParts(bounded, bound, max_depth),
                                         {8, passes, 31, {{"far", sum}, {"left", left}}});
    const auto all = render_statistics(
        *scene, *integrator_from(R"(<integrator type="volpath">)" + depth + "</integrator>"),
        {8, passes, 32, {{"far", far}}});
    // The test has the power to see an error of 8 %, up or down.
    check_same_mean(parts, "far", all, "far", {1.08, 0.92});
    CHECK_FALSE(same_mean(parts, "left", all, "far", OnFailure::nothing).passed);  // something is missing
}

std::string with_glass_ball(std::string xml) {
    return xml.insert(xml.find("<sensor"),
                      R"(<shape type="sphere"><point name="center" x="-0.3" y="-0.4" z="0.2"/>
        <float name="radius" value="0.5"/><bsdf type="dielectric"/></shape>)");
}

}  // namespace

TEST_CASE("What the bound of VPLs takes and what it leaves are all light", "[vpl][missing][equality]") {
    check(box(grey, ""), 2.0f, 6000);
    check(box(mixed, ""), 2.0f, 6000);
    check(box(grey, ""), 2.0f, 6000, 3);
}
TEST_CASE("What the bound of VPLs takes in fog and what it leaves are all light",
          "[vpl][missing][equality][media]") {
    check(box(grey, fog("0.8, 1.0, 1.3", "")), 2.0f, 6000);
}
TEST_CASE("Light through mirrors and glass is missing from VPLs", "[vpl][missing][equality]") {
    check(with_glass_ball(box(grey, "")), 1e6f, 8000);
    check(with_glass_ball(box(grey, "")), 2.0f, 8000);
}
