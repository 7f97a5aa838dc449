// Methods that render a list of pixels see there what they see in the whole picture, and control passes of
// mote_layers have its mean, by other random numbers.
#include <algorithm>

#include "core/film/pixel_columns.h"
#include "core/render/pass_runner.h"
#include "core/scene/scene.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::tests;

namespace {

constexpr int size = 12, rows = 3;

/// All pixels of the picture, last first. `shift`: of what they show; a planted error.
PixelColumns columns_of(const RenderOptions& options, int shift) {
    std::vector<Vec2i> pixels;
    for (int y = options.height; y-- > 0;)
        for (int x = options.width; x-- > 0;) pixels.emplace_back((x + shift) % options.width, y);
    return {std::move(pixels), rows};
}

/// The picture of an image of those columns, its rows averaged.
void gather(const PassImage& of_columns, PassImage& image) {
    const std::size_t pixels = image.layer(0).size();
    for (std::size_t layer = 0; layer < image.layers(); ++layer)
        for (std::size_t p = 0; p < pixels; ++p) {
            Rgb sum(0.0f);
            for (std::size_t row = 0; row < rows; ++row)
                sum += of_columns.layer(layer)[row * pixels + pixels - 1 - p];
            image.layer(layer)[p] = sum / float(rows);
        }
}

/// A method that renders its picture as a list of pixels.
class InColumns final : public Integrator {
  public:
    InColumns(std::shared_ptr<const Integrator> method, int shift)
        : method_(std::move(method)), shift_(shift) {}
    std::string type() const override { return method_->type(); }
    std::vector<Layer> layers(const Scene& scene) const override { return method_->layers(scene); }
    Plan plan(const Scene& scene, const Requirements& r) const override { return method_->plan(scene, r); }
    std::unique_ptr<Estimator> prepare(const Scene& scene, const RenderOptions& options) const override {
        struct Columns final : Estimator {
            std::unique_ptr<Estimator> estimator;
            PassImage image;
            Columns(std::unique_ptr<Estimator> e, PassImage i)
                : estimator(std::move(e)), image(std::move(i)) {}
            bool pass(const PassContext& context, PassImage& picture) override {
                image.clear();
                if (!estimator->pass(context, image)) return false;
                gather(image, picture);
                return true;
            }
        };
        RenderOptions own = options;
        own.columns = columns_of(options, shift_);
        own.width = own.columns.columns(), own.height = rows;
        return std::make_unique<Columns>(method_->prepare(scene, own),
                                         PassImage(own.width, own.height, layers(scene).size()));
    }

  private:
    std::shared_ptr<const Integrator> method_;
    int shift_;
};

/// The control passes of a part of another method as a picture of one layer.
class Controls final : public Integrator {
  public:
    Controls(std::shared_ptr<const Integrator> method, std::size_t part)
        : method_(std::move(method)), part_(part) {}
    std::string type() const override { return method_->type(); }
    std::vector<Layer> layers(const Scene&) const override { return {Layer{"light", ""}}; }
    Plan plan(const Scene& scene, const Requirements& r) const override { return method_->plan(scene, r); }
    std::unique_ptr<Estimator> prepare(const Scene& scene, const RenderOptions& options) const override {
        struct OfPart final : Estimator {
            std::unique_ptr<Estimator> estimator;
            PixelColumns columns;
            PassImage image;
            std::size_t part;
            OfPart(std::unique_ptr<Estimator> e, const PixelColumns& c, std::size_t p)
                : estimator(std::move(e)), columns(c), image(c.columns(), c.rows(), 1), part(p) {}
            bool pass(const PassContext& context, PassImage& picture) override {
                image.clear();
                const PassContext own{context.index, context.filter, context.cancelled, part};
                if (!estimator->control_pass(columns, own, image)) return false;
                gather(image, picture);
                return true;
            }
        };
        return std::make_unique<OfPart>(method_->prepare(scene, options), columns_of(options, 0), part_);
    }

  private:
    std::shared_ptr<const Integrator> method_;
    std::size_t part_;
};

const std::string lens = R"(<sensor type="thinlens"><float name="fov" value="40"/>
    <float name="aperture_radius" value="0.1"/><float name="focus_distance" value="3"/><transform name="to_world">
    <lookat origin="0.4, 0, 3.6" target="0, 0, 0" up="0, 1, 0"/></transform></sensor>)";
const std::string lamp_inside = R"(<emitter type="point"><point name="position" x="0.2" y="0.1" z="0.3"/>
    <rgb name="intensity" value="2, 3, 4"/></emitter>)";

std::string lit_fog() {
    std::string xml = box(grey, fog("0.8, 0.5, 0.3", ""));
    return xml.insert(xml.find("<sensor"), lamp_inside);
}

void check_columns(const std::string& xml, const std::string& integrator) {
    const auto scene = scene_from(xml, size);
    const auto method = integrator_from(integrator);
    REQUIRE(method->renders_columns());
    RenderSpec spec;
    spec.block = 2, spec.passes = 512;
    const RenderStatistics whole = render_statistics(*scene, *method, spec);
    spec.seed = 2;
    const RenderStatistics listed = render_statistics(*scene, InColumns(method, 0), spec);
    for (const std::string& layer : whole.layers) check_same_mean(whole, layer, listed, layer);
    RenderStatistics shifted = render_statistics(*scene, InColumns(method, 2), spec);
    shifted.planted = true;
    CHECK_FALSE(same_mean(whole, "beauty", shifted, "beauty", OnFailure::nothing).passed);
    CHECK(listed.non_finite == 0);
}

}  // namespace

TEST_CASE("Pixels of a list are those of the picture", "[integrators][controls]") {
    check_columns(box(grey, ""), R"(<integrator type="path"/>)");
    check_columns(with_sensor(box(glossy, ""), lens), R"(<integrator type="path"/>)");
    check_columns(box(grey, fog("0.8, 0.5, 0.3", "")), R"(<integrator type="volpath"/>)");
    check_columns(with_sensor(lit_fog(), lens), R"(<integrator type="volpath"/>)");
    CHECK_FALSE(
        integrator_from(R"(<integrator type="volpath"><string name="guiding" value="on"/></integrator>)")
            ->renders_columns());
    CHECK_FALSE(integrator_from(R"(<integrator type="mote_vpl"/>)")->renders_columns());
}

TEST_CASE("Control passes of mote_layers have the mean of its parts", "[integrators][controls]") {
    const auto method = integrator_from(
        R"(<integrator type="mote_layers"><string name="filter" value="none"/>
           <integrator type="mote_single_scattering" name="emission, direct, single_scattering"/>
           <integrator type="volpath" name="indirect, multiple_scattering"/></integrator>)");
    const auto scene = scene_from(lit_fog(), size);
    const auto estimator = method->prepare(*scene, {.seed = 3, .width = size, .height = size});
    CHECK_FALSE(estimator->has_control_passes(0));
    REQUIRE(estimator->has_control_passes(1));

    const auto far = integrator_from(
        R"(<integrator type="mote_layers"><string name="filter" value="none"/>
           <integrator type="volpath" name="indirect, multiple_scattering"/></integrator>)");
    RenderSpec spec;
    spec.block = 2, spec.passes = 512;
    const RenderStatistics whole = render_statistics(*scene, *far, spec);
    spec.seed = 2;
    const RenderStatistics controls = render_statistics(*scene, Controls(method, 1), spec);
    check_same_mean(whole, "beauty", controls, "light", {1.1});
}
