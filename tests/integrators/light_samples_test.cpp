// Several samples of lights at one vertex: their numbers, how many a scene gets, and that the light of paths
// is the same for any number.
#include "integrators/eye_path/light_samples.h"

#include <cmath>
#include <set>

#include "core/render/render_driver.h"
#include "tests/integrators/paths_of_a_pass.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

using namespace mote;
using namespace mote::core;
using namespace mote::integrators;
using namespace mote::tests;

namespace {

const std::string point_light =
    R"(<emitter type="point"><point name="position" x="0.3" y="0.2" z="0.9"/></emitter>)";
const std::string sky = R"(<emitter type="constant"><rgb name="radiance" value="0.8, 1, 1.2"/></emitter>)";
const std::string ball_light =
    R"(<shape type="sphere"><float name="radius" value="0.15"/><point name="center" x="-0.4" y="-0.3" z="0.3"/>
    <emitter type="area"><rgb name="radiance" value="5, 4, 3"/></emitter></shape>)";

/// Light of the whole picture by layer.
struct Light {
    std::array<double, transport_count> mean{}, variance{};  ///< of the mean over passes
};

template <bool Media>
Light light_of(const Scene& scene, const LightSamples& samples, std::uint64_t seed) {
    constexpr int size = 8, pixels = size * size;
    constexpr std::uint32_t passes = 1500;
    PathSettings settings;
    settings.limits.max_depth = 5, settings.limits.light_samples = samples;
    const RenderOptions options{.seed = seed, .width = size, .height = size};
    const auto filter = make_pixel_filter("box", 0.5f, 0.5f);
    const std::atomic<bool> cancelled{false};
    WalkContext walk;
    const auto packet =
        std::make_unique<EyePacket<Media>>(scene, EyePacketSettings{.limits = settings.limits}, walk);
    Light light;
    std::array<double, transport_count> squares{};
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        const PassContext context{pass, *filter, cancelled};
        std::array<double, transport_count> sums{};
        for_each_path(scene, settings, options, context, *packet, [&](int, const TransportSum& sum) {
            for (std::size_t l = 0; l < transport_count; ++l)
                sums[l] += double(average(sum.light[l])) / pixels;
        });
        for (std::size_t l = 0; l < transport_count; ++l)
            light.mean[l] += sums[l] / passes, squares[l] += sqr(sums[l]) / passes;
    }
    for (std::size_t l = 0; l < transport_count; ++l)
        light.variance[l] = std::max(0.0, squares[l] - sqr(light.mean[l])) / (passes - 1);
    return light;
}

/// Two-sided tests of every layer at a level of 1 % for the three comparisons of three scenes' five layers.
template <bool Media>
void check_same_light(const std::string& xml) {
    const auto scene = scene_from(xml, 8);
    const Light one = light_of<Media>(*scene, {1, 1}, 1);
    constexpr double critical_z = 4.0;  // 45 tests of 6e-5
    for (const LightSamples& samples : {LightSamples{2, 2}, LightSamples{3, 1}, LightSamples{1, 5}}) {
        const Light more = light_of<Media>(*scene, samples, 2);
        for (std::size_t l = 0; l < transport_count; ++l) {
            const double deviation = std::sqrt(one.variance[l] + more.variance[l]);
            INFO(samples.surfaces << ", " << samples.media << " samples, layer " << l << ": " << one.mean[l]
                                  << " against " << more.mean[l] << " +- " << deviation);
            CHECK(std::fabs(one.mean[l] - more.mean[l]) <= critical_z * deviation + 1e-6 * one.mean[l]);
        }
    }
}

}  // namespace

TEST_CASE("numbers of several samples of lights are spread evenly, each like the first",
          "[integrators][light_samples]") {
    for (const int n : {1, 2, 3, 4, 7}) {
        constexpr int cells = 16, count = 4096;
        for (int k = 0; k < n; ++k) {
            std::array<std::array<int, cells>, 3> hits{};
            for (int i = 0; i < count; ++i) {
                const float x = (float(i) + 0.5f) / count;
                const LightNumbers u = numbers_of_light({x, {x, x}}, k, n);
                const float numbers[3] = {u.choice, u.point.x, u.point.y};
                for (int d = 0; d < 3; ++d) {
                    REQUIRE((numbers[d] >= 0.0f && numbers[d] < 1.0f));
                    ++hits[std::size_t(d)][std::size_t(numbers[d] * cells)];
                }
            }
            for (const auto& dimension : hits)
                for (const int hit : dimension) CHECK(std::abs(hit - count / cells) <= 1);
        }
        // One choice in every n-th part, and no two points alike.
        std::set<int> parts;
        std::set<float> points;
        for (int k = 0; k < n; ++k) {
            const LightNumbers u = numbers_of_light({0.9f, {0.3f, 0.8f}}, k, n);
            parts.insert(int(u.choice * float(n))), points.insert(u.point.x);
        }
        CHECK(int(parts.size()) == n);
        CHECK(int(points.size()) == n);
    }
    // The largest number below 1 stays below it.
    const float last = std::nextafter(1.0f, 0.0f);
    for (int k = 0; k < 100; ++k) {
        const LightNumbers u = numbers_of_light({last, {last, last}}, k, 100);
        CHECK((u.choice < 1.0f && u.point.x < 1.0f && u.point.y < 1.0f));
    }
}

TEST_CASE("samples of lights are as many as differ", "[integrators][light_samples]") {
    const auto of = [](const std::string& xml) { return light_samples_for(*scene_from(xml, 8)); };
    const std::string dark =
        R"(<scene version="3.0.0"><shape type="sphere"/><sensor type="perspective"/></scene>)";
    CHECK(of(with(dark, point_light)).at_most() == 1);
    CHECK(of(with(dark, sky)).surfaces == 2);
    CHECK(of(with(dark, sky)).media == 2);
    CHECK(of(with(dark, point_light + point_light)).surfaces == 2);
    const TemporaryFolder folder;
    const std::string smoke = smoke_medium(folder.file("smoke.vol"));
    CHECK(of(box(grey, fog("1, 1, 1", ""))).media == 2);
    CHECK(of(box(grey, smoke)).media == 1);
    CHECK(of(box(grey, smoke)).surfaces == 2);
    constexpr LightSamples samples{2, 3};
    CHECK((samples.at(0, true) == 2 && samples.at(1, true) == 2 && samples.at(2, true) == 1));
    CHECK((samples.at(0, false) == 3 && samples.at(1, false) == 3 && samples.at(2, false) == 1));
}

TEST_CASE("any number of samples of lights has the same light", "[integrators][light_samples]") {
    check_same_light<false>(with(box(mixed, ""), point_light + ball_light + sky));
    check_same_light<true>(
        with(box(glossy, fog("0.9, 0.7, 0.5", R"(<phase type="hg"><float name="g" value="0.7"/></phase>)")),
             point_light + ball_light + sky));
    check_same_light<true>(with(box(grey, fog("0.5, 0.4, 0.3", "")), glowing_cube(true)));
}
