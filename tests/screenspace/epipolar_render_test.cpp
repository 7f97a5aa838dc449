// `mote_epipolar` and `mote_single_scattering` against each other and against volpath.
#include <fmt/format.h>

#include <algorithm>

#include "tests/screenspace/epipolar_scenes.h"
#include "tests/support/temporary_folder.h"

using namespace mote;
using namespace mote::core;
using namespace mote::tests;

namespace {

const std::string lamps = R"(
    <emitter type="point"><point name="position" x="0.6" y="0.4" z="1.5"/><rgb name="intensity" value="3, 3.5, 4"/></emitter>
    <emitter type="spot"><transform name="to_world"><lookat origin="-0.6, 0.7, 1.7" target="0, -0.4, 0" up="0, 0, 1"/>
        </transform><rgb name="intensity" value="40, 30, 20"/></emitter>)";

const std::string thin_fog =
    fog("0.5, 0.4, 0.3", R"(<phase type="hg"><float name="g" value="0.5"/></phase>)");

const std::string few_steps =
    R"(<integrator type="mote_single_scattering"><integer name="steps" value="4"/></integrator>)";
std::string sub_sampled(double spacing) {
    return fmt::format(
        R"(<integrator type="mote_single_scattering"><string name="sampling" value="sub_sampled"/>
        <float name="spacing" value="{}"/></integrator>)",
        spacing);
}

/// How much light changes from a pixel to the one `stride` further on, as a fraction of the mean.
double change(const Picture& picture, std::size_t stride) {
    double sum = 0.0;
    for (std::size_t i = stride; i < picture.pixels.size(); ++i)
        sum += std::abs(picture.pixels[i].x - picture.pixels[i - stride].x);
    return sum / double(picture.pixels.size() - stride) / picture.mean();
}

/// A fence beside the block, that cuts the light from the right into shafts.
const std::string bars = [] {
    std::string xml;
    for (int i = 0; i < 9; ++i)
        xml += fmt::format(R"(<shape type="cube"><transform name="to_world"><scale x="0.02" y="0.035" z="1"/>
            <translate x="1.9" y="{}" z="0"/></transform><bsdf type="diffuse"/></shape>)",
                           0.1 + 0.1 * i);
    return xml;
}();

void check_against_volpath(const std::string& xml, const std::string& integrator, std::uint32_t passes,
                           std::vector<std::string> layers) {
    const auto scene = scene_from(xml, 8);
    const auto ours = render_statistics(*scene, *integrator_from(integrator), {8, passes, 5});
    const auto reference = render_statistics(
        *scene, *integrator_from(R"(<integrator type="volpath"><integer name="max_depth" value="4"/>
            <boolean name="equiangular" value="true"/></integrator>)"),
        {8, 4 * passes, 6});
    for (const std::string& layer : layers) {
        check_same_mean(ours, layer, reference, layer, {1.1});
    }
}

}  // namespace

TEST_CASE("Marching at full rate has volpath's mean", "[epipolar]") {
    check_against_volpath(with(without_area_light(box(grey, thin_fog)), lamps), few_steps, 300,
                          {"direct", "single_scattering"});
}

TEST_CASE("Lights without a position and mirrors join in at full rate", "[epipolar]") {
    const std::string mirror =
        R"(<shape type="rectangle"><transform name="to_world"><scale x="0.5" y="0.8" z="1"/>
        <rotate y="1" angle="15"/><translate x="-0.3" z="-0.8"/></transform><bsdf type="conductor"/></shape>)";
    check_against_volpath(with(box(grey, thin_fog), lamps + mirror), few_steps, 300,
                          {"direct", "single_scattering"});
}

TEST_CASE("Grids are marched as closely as volpath tracks them", "[epipolar]") {
    const TemporaryFolder folder;
    check_against_volpath(with(box(grey, smoke_medium(folder.file("smoke.vol"))), lamps), few_steps, 300,
                          {"direct", "single_scattering"});
}

TEST_CASE("Epipolar pictures converge to full rate", "[epipolar]") {
    for (const Vec3d& light : {Vec3d(0.1, 0.6, 0.5), Vec3d(2.5, 0.5, 0.0)}) {
        const auto scene = sized(block_in_fog(light, bars), 24, 18);
        const std::string steps = R"(<integer name="steps" value="128"/>)";
        const Picture reference =
            render(*scene, R"(<integrator type="mote_single_scattering">)" + steps + "</integrator>");
        const auto at = [&](int rate) {
            const std::string texels = fmt::format(R"(<float name="texels" value="{}"/>)", 0.5 * rate);
            return render(*scene, epipolar(40 * rate, 8 * rate * rate, steps + texels));
        };
        const Picture finest = at(9);
        const double coarse = relative_error(at(1), reference), middle = relative_error(at(3), reference),
                     fine = relative_error(finest, reference);
        INFO("light " << light.x << ": " << coarse << ", " << middle << ", " << fine);
        // Three times as fine: beside edges of shafts pixels are hit or missed, so the error is of first
        // order in the distance of lines where edges fall evenly, and of order one half at least.
        CHECK(middle < coarse / std::sqrt(3.0));
        CHECK(fine < middle / std::sqrt(3.0));
        // Remaining errors fall to either side, pixel by pixel.
        const auto bias = [&](double factor) {  // in standard errors
            double sum = 0.0, squares = 0.0;
            for (std::size_t i = 0; i < finest.pixels.size(); ++i) {
                const double d = factor * finest.pixels[i].x - reference.pixels[i].x;
                sum += d, squares += d * d;
            }
            return std::abs(sum) / std::sqrt(squares);
        };
        CHECK(bias(1.0) < 4.5);
        CHECK(bias(1.02) > 4.5);  // planted
    }
}

TEST_CASE("Epipolar lines beat a grid of as many rays where there are shafts", "[epipolar]") {
    const auto scene = sized(block_in_fog({2.5, 0.5, 0.0}, bars), 120, 80);
    const Picture reference = render(*scene, full), lines = render(*scene, epipolar(160, 6));
    const Picture grid = render(*scene, sub_sampled(2.0));
    const double share =
        lines.statistics.values.at("marched_rays") / reference.statistics.values.at("marched_rays");
    const double grid_share =
        grid.statistics.values.at("marched_rays") / reference.statistics.values.at("marched_rays");
    const double one = relative_error(lines, reference), rival = relative_error(grid, reference);
    INFO("lines: " << share << " of the rays, error " << one << "; grid: " << grid_share << ", " << rival);
    CHECK(share < 0.3);
    CHECK(share < grid_share);
    CHECK(one < rival);
    const double many = relative_error(render(*scene, epipolar(160, 6), 8), render(*scene, full, 8));
    CHECK(many < 0.7 * one);  // passes are independent
}

TEST_CASE("Sweeping the light past the frame and behind the camera makes no jump in error", "[epipolar]") {
    // From the picture's middle over its border, beside the camera, and to behind it: 60 positions.
    std::vector<double> errors;
    for (int i = 0; i < 60; ++i) {
        const double angle = (0.02 + 0.95 * i / 59.0) * double(pi);  // from the view, at the camera
        const auto scene =
            sized(block_in_fog(Vec3d(2.5 * std::sin(angle), 0.3, 4.0 - 2.5 * std::cos(angle))), 32, 24);
        errors.push_back(
            relative_error(render(*scene, epipolar(96, 12, tolerance(0.01))), render(*scene, full)));
        INFO("position " << i << ", error " << errors.back());
        CHECK(errors.back() < 0.01);
    }
    for (std::size_t i = 1; i + 1 < errors.size(); ++i) {  // no spike above its neighbours
        INFO("position " << i << ": " << errors[i - 1] << ", " << errors[i] << ", " << errors[i + 1]);
        CHECK(errors[i] < 2.0 * std::max(errors[i - 1], errors[i + 1]) + 0.0005);
    }
}

TEST_CASE("A spot light with a texture sends shafts of its pattern", "[epipolar]") {
    std::string xml = block_in_fog({0.0, 0.0, 0.0});
    const auto begin = xml.find("<emitter"), end = xml.find("</emitter>") + 10;
    xml.replace(begin, end - begin, R"(<emitter type="spot"><float name="cutoff_angle" value="25"/>
        <float name="beam_width" value="25"/><rgb name="intensity" value="5"/>
        <transform name="to_world"><lookat origin="2.5, 0.5, -1" target="0, 0, 0.5" up="0, 1, 0"/></transform>
        <texture name="texture" type="checkerboard"><rgb name="color0" value="0"/><rgb name="color1" value="1, 0.5, 0.2"/>
        <transform name="to_uv"><scale x="4" y="4" z="1"/></transform></texture></emitter>)");
    const auto scene = sized(xml, 96, 64);
    const Picture reference = render(*scene, full);
    CHECK(reference.mean() > 0.0);
    const Picture lines = render(*scene, epipolar(160, 8)), dark = render(*scene, epipolar(3, 8));
    const double error = relative_error(lines, reference);
    INFO(error << ", with three lines " << relative_error(dark, reference));
    CHECK(error < usual_tolerance);
    CHECK(relative_error(dark, reference) > 2.0 * usual_tolerance);
    CHECK(lines.statistics.values.at("marched_rays") < 0.4 * reference.statistics.values.at("marched_rays"));
    // Outside the cone nothing is marched, in either.
    CHECK(reference.statistics.values.at("marched_rays") < 0.9 * 96 * 64);
}

TEST_CASE("A light at the camera, on a pixel and on the border", "[epipolar]") {
    const double half = std::tan(25.0 * double(pi) / 180.0);
    for (const Vec3d& light : {Vec3d(0, 0, 4), Vec3d(1e-7, 0, 4), Vec3d(0.001, 0, 4), Vec3d(0, 0, 3),
                               Vec3d(2 * half, 0, 2), Vec3d(2 * half, 1.5 * half, 2), Vec3d(1.0, 0, 4)}) {
        const auto scene = sized(block_in_fog(light), 48, 36);
        const Picture reference = render(*scene, full);
        const double error = relative_error(render(*scene, epipolar(120, 16, tolerance(0.01))), reference);
        INFO("light at " << light.x << ", " << light.y << ", " << light.z << ": " << error);
        CHECK(error < 0.01);
    }
}

TEST_CASE("Pictures of one pixel and of one row", "[epipolar]") {
    for (const auto& [w, h] : std::vector<std::pair<int, int>>{{1, 1}, {2, 1}, {3, 300}, {8192, 1}}) {
        INFO(w << " x " << h);
        const std::string xml = block_in_fog({0.3, 0.1, 0.5});
        const auto scene = sized(xml, w, h);
        const Picture reference = render(*scene, full);
        // A pixel of one or two holds much of the view: lines need texels within it to find how light varies.
        const std::string more = tolerance(0.02) + R"(<float name="texels" value="4"/>)";
        CHECK(relative_error(render(*scene, epipolar(256, 8, more)), reference) < 0.02);
        // A sub-sampled pixel is a mean of rays at most two pixels away, or its own ray.
        const Picture grid = render(*scene, sub_sampled(2.0));
        if (w * h > 2) {
            const double two_pixels = change(reference, std::size_t(w < h ? 2 * w : 2));
            CHECK(two_pixels < 0.1);
            CHECK(relative_error(grid, reference) < two_pixels);
        } else {
            std::vector<double> seen;  // anywhere in the view
            for (const Vec3d& pixel : render(*sized(xml, 32 * w, 32 * h), full).pixels)
                seen.push_back(pixel.x);
            const auto [least, most] = std::minmax_element(seen.begin(), seen.end());
            CHECK(*least > 0.0);
            for (const Vec3d& pixel : grid.pixels) CHECK((pixel.x >= *least && pixel.x <= *most));
        }
    }
}

TEST_CASE("Black lights, closed eyes and vacuum", "[epipolar]") {
    const std::string lid =
        R"(<shape type="sphere"><point name="center" x="0" y="0" z="4"/><float name="radius"
        value="0.2"/><bsdf type="diffuse"/></shape>)";
    CHECK(render(*sized(block_in_fog({0.3, 0.1, 0.5}), 16, 16), epipolar(32, 4)).mean() > 0.0);
    CHECK(render(*sized(block_in_fog({0.3, 0.1, 0.5}, lid), 16, 16), epipolar(32, 4)).mean() == 0.0);
    std::string black = block_in_fog({0.3, 0.1, 0.5});
    black.insert(black.find("</emitter>"), R"(<rgb name="intensity" value="0"/>)");
    CHECK(render(*sized(black, 16, 16), epipolar(32, 4)).mean() == 0.0);

    const auto vacuum = scene_from(box(grey, ""), 8);
    const auto ours = render_statistics(*vacuum, *integrator_from(epipolar(32, 4)), {8, 200, 1});
    const auto path =
        render_statistics(*vacuum, *integrator_from(R"(<integrator type="path"/>)"), {8, 400, 2});
    CHECK(ours.layers.size() == 3);  // emission, direct, beauty
    for (const char* layer : {"emission", "direct"}) CHECK(same_mean(ours, layer, path, layer).passed);
}

TEST_CASE("The plan says when nothing epipolar is needed", "[epipolar]") {
    const auto plan_of = [](const std::string& xml) {
        const auto scene = scene_from(xml, 8);
        return integrator_from(epipolar(32, 4))->plan(*scene, find_requirements(*scene)).to_text();
    };
    CHECK_THAT(plan_of(box(grey, "")), ContainsSubstring("the scene has no medium"));
    CHECK_THAT(plan_of(box(grey, thin_fog)), ContainsSubstring("no light has a position"));
    CHECK_THAT(plan_of(with(box(grey, thin_fog), lamps)),
               ContainsSubstring("32 for each of 2 lights") && ContainsSubstring("other lights"));
}
