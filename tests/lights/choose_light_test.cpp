// The choice of a light for a receiver, over real lights of every kind: sampled as stated, adding up to 1,
// and none left out that shines.
#include <fmt/format.h>

#include "core/math/warp.h"
#include "core/scene/light_tree.h"
#include "core/scene/scene.h"
#include "lights/emitters/other_lights.h"
#include "tests/support/catch.h"
#include "tests/support/pearson.h"
#include "tests/support/render_statistics.h"

using namespace mote::tests;
using namespace mote::core;

namespace {

std::string placed(Rng& rng, const std::string& more = "") {
    const Vec3 p = 4.0f * Vec3(rng.next_float(), rng.next_float(), rng.next_float()) - 2.0f;
    const Vec3 axis = square_to_sphere(rng.next_vec2());
    return fmt::format(
        R"(<transform name="to_world">{}<rotate x="{}" y="{}" z="{}" angle="{}"/><translate x="{}" y="{}" z="{}"/></transform>)",
        more, axis.x, axis.y, axis.z, 360.0f * rng.next_float(), p.x, p.y, p.z);
}

/// Three of every kind, turned and moved at random, in a cube of 4 m; one is a thousand times brighter.
std::unique_ptr<Scene> all_lights() {
    Rng rng(17);
    std::string xml = R"(<scene version="3.0.0"><sensor type="perspective"/>)";
    for (int i = 0; i < 3; ++i) {
        const std::string area =
            fmt::format(R"(<emitter type="area"><rgb name="radiance" value="{}, 1, 2"/></emitter>)",
                        i == 0 ? 1000.0f : 1.0f);
        for (const char* shape : {"rectangle", "disk", "sphere", "cylinder", "cube"})
            xml += fmt::format(R"(<shape type="{}">{}{}</shape>)", shape,
                               placed(rng, R"(<scale x="0.3" y="0.1" z="0.2"/>)"), area);
        xml += fmt::format(R"(<emitter type="point"><point name="position" x="{}" y="{}" z="1"/></emitter>)",
                           rng.next_float(), rng.next_float());
        for (const int cutoff : {10, 60, 90, 120, 180})
            xml += fmt::format(R"(<emitter type="spot">{}<float name="cutoff_angle" value="{}"/></emitter>)",
                               placed(rng), cutoff);
        xml += fmt::format(
            R"(<emitter type="spot">{}<float name="cutoff_angle" value="40"/><texture type="checkerboard"/></emitter>)",
            placed(rng));
        for (const int fov : {10, 45, 150})
            xml += fmt::format(
                R"(<emitter type="projector">{}<float name="fov" value="{}"/><texture type="checkerboard" name="irradiance"/></emitter>)",
                placed(rng), fov);
    }
    xml +=
        R"(<emitter type="constant"/><emitter type="directional"><vector name="direction" x="0" y="0" z="1"/></emitter>)";
    return scene_from(xml + "</scene>");
}

/// On surfaces that look anywhere, and in media.
std::vector<LightReceiver> receivers(int count) {
    Rng rng(19);
    std::vector<LightReceiver> result;
    for (int i = 0; i < count; ++i) {
        LightReceiver r{6.0f * Vec3(rng.next_float(), rng.next_float(), rng.next_float()) - 3.0f};
        if (i % 2) r.normal = square_to_sphere(rng.next_vec2());
        result.push_back(r);
    }
    return result;
}

/// Samples for one receiver against the probabilities stated for another; they are the same but where an
/// error is planted.
Chi2Result chi2_of_choice(const LitScene& scene, const LightReceiver& sampled_for,
                          const LightReceiver& stated_for, std::size_t& impossible) {
    constexpr int samples = 50000;
    std::map<const Emitter*, double> counts;
    Rng rng(23);
    for (int i = 0; i < samples; ++i) ++counts[scene.choose_light(sampled_for, rng.next_float()).emitter];
    std::vector<Cell> cells;
    for (const auto& light : scene.emitters())
        cells.push_back(
            {samples * double(scene.light_probability(stated_for, light.get())), counts[light.get()]});
    Chi2Result result;
    impossible = impossible_cells(cells, 1e-6);
    pearson(cells, result);
    return result;
}

}  // namespace

TEST_CASE("the chances of all lights of a scene add up to 1 for any receiver", "[lights][light_tree]") {
    const auto scene = all_lights();
    for (const LightReceiver& receiver : receivers(200)) {
        double sum = 0.0;
        for (const auto& light : scene->emitters())
            sum += double(scene->light_probability(receiver, light.get()));
        CHECK(sum == Approx(1.0).epsilon(1e-5));  // single precision, 44 lights
    }
}

TEST_CASE("lights are sampled with the chance that is stated", "[lights][light_tree][chi2]") {
    const auto scene = all_lights();
    constexpr std::size_t tests = 8;
    const auto at = receivers(tests);
    for (std::size_t i = 0; i < tests; ++i) {
        std::size_t impossible = 0;
        const Chi2Result result = chi2_of_choice(*scene, at[i], at[i], impossible);
        INFO("receiver " << i << ": chi2 " << result.statistic << ", p " << result.p_value);
        CHECK(impossible == 0);
        CHECK(result.p_value >= sidak_level(0.01, tests));
    }
    // Planted: the chances of a receiver half a metre away. Some are lit by much the same lights there.
    int found = 0;
    for (const LightReceiver& here : at) {
        std::size_t impossible = 0;
        const LightReceiver beside{here.position + Vec3(0.5f, 0.0f, 0.0f), here.normal};
        found += chi2_of_choice(*scene, here, beside, impossible).p_value < sidak_level(0.01, tests);
    }
    CHECK(found >= 6);
    for (const LightReceiver& receiver : at) {
        const LightChoice choice = scene->choose_light(receiver, 0.7f);
        CHECK(choice.probability == Approx(scene->light_probability(receiver, choice.emitter)).epsilon(1e-5));
    }
}

TEST_CASE("no light that shines on a receiver is left out", "[lights][light_tree]") {
    const auto scene = all_lights();
    Rng rng(29);
    // A hierarchy alone, without the samples by power that the scene adds.
    std::vector<LightBounds> bounds;
    std::map<const Emitter*, std::uint32_t> in_tree;
    for (const auto& light : scene->emitters())
        if (const auto place = light->bounds()) {
            in_tree.emplace(light.get(), bounds.size());
            bounds.push_back(*place);
        }
    CHECK(in_tree.size() == scene->emitters().size() - 2);
    const LightTree tree(bounds);
    std::map<const Emitter*, int> shone;
    for (const LightReceiver& receiver : receivers(3000))
        for (const auto& light : scene->emitters()) {
            const auto sample = light->sample_direct(receiver.position, rng.next_vec2());
            if (!sample || is_black(sample->weight)) continue;
            if (receiver.normal != Vec3(0.0f) && !(glm::dot(receiver.normal, sample->wi) > 0.0f)) continue;
            ++shone[light.get()];
            CHECK(scene->light_probability(receiver, light.get()) > 0.0f);
            if (in_tree.contains(light.get())) CHECK(tree.probability(receiver, in_tree[light.get()]) > 0.0);
        }
    CHECK(shone.size() == scene->emitters().size());  // each did, somewhere
}

TEST_CASE("without some of its lights a scene samples the others alone, with the chance that is stated",
          "[lights][light_tree][chi2]") {
    const auto scene = all_lights();
    std::vector<const Emitter*> left_out;
    for (const auto& light : scene->emitters())
        if (light->traits().delta_position) left_out.push_back(light.get());
    REQUIRE(left_out.size() == 30);
    const mote::lights::OtherLights others(*scene, left_out);
    REQUIRE(others.any());
    constexpr std::size_t tests = 4;
    for (const LightReceiver& receiver : receivers(tests)) {
        double sum = 0.0;
        for (const auto& light : scene->emitters())
            sum += double(others.light_probability(receiver, light.get()));
        CHECK(sum == Approx(1.0).epsilon(1e-4));
        for (const Emitter* light : left_out) CHECK(others.light_probability(receiver, light) == 0.0f);
        std::size_t impossible = 0;
        const Chi2Result result = chi2_of_choice(others, receiver, receiver, impossible);
        INFO("chi2 " << result.statistic << ", p " << result.p_value);
        CHECK(impossible == 0);
        CHECK(result.p_value >= sidak_level(0.01, tests));
    }
    std::vector<const Emitter*> all;
    for (const auto& light : scene->emitters()) all.push_back(light.get());
    const mote::lights::OtherLights none(*scene, all);
    CHECK_FALSE(none.any());
    CHECK(none.choose_light(receivers(1)[0], 0.3f).emitter == nullptr);
}
