// Many-light methods over a host's rays: a closed cube of grey walls with a lamp, whose walls receive
// power / (area (1 - reflectance)) in all, in fog that does not absorb as well.
#include "session/host/host_light.h"

#include <atomic>
#include <cmath>

#include "tests/support/catch.h"

using namespace mote;
using core::Rgb, core::Vec3;

namespace {

constexpr double intensity = 2.0, reflectance = 0.5, pi = 3.14159265358979;
constexpr double all_light = 4.0 * pi * intensity / (6.0 * (1.0 - reflectance));  // [W/m^2]
const Vec3 lamp(0.4f, 0.5f, 0.6f);

std::optional<session::HostHit> wall(const session::HostSegment& s) {
    session::HostHit hit{core::infinity, {}, 1};
    for (int axis = 0; axis < 3; ++axis) {
        const float d = s.direction[axis], t = ((d > 0.0f ? 1.0f : 0.0f) - s.origin[axis]) / d;
        if (d != 0.0f && t < hit.distance) hit.distance = t, hit.normal = Vec3(0.0f), hit.normal[axis] = 1.0f;
    }
    if (!(hit.distance > 0.0f && hit.distance < s.length)) return {};
    return hit;
}

session::HostSceneData room(float fog = 0.0f) {
    session::HostSceneData data;
    data.reflectance = {Rgb(0.0f), Rgb(float(reflectance))};
    data.lamps = {{core::Vec3d(lamp), Rgb(float(intensity))}};
    data.scattering = Rgb(fog), data.bounds = {Vec3(0.0f), Vec3(1.0f)}, data.first_hit = wall;
    return data;
}

/// Places on the walls, evenly by area; `margin` of each wall is left out.
std::vector<session::HostReceiver> places(std::uint64_t seed, int count, float margin = 0.0f) {
    core::Rng rng(seed);
    std::vector<session::HostReceiver> result;
    for (int i = 0; i < count; ++i) {
        session::HostReceiver r{Vec3(0.0f), Vec3(0.0f), 1};
        for (int k = 0; k < 3; ++k) r.position[k] = margin + (1.0f - 2.0f * margin) * rng.next_float();
        const int axis = std::min(2, int(3.0f * rng.next_float()));
        const bool upper = rng.next_float() < 0.5f;
        r.position[axis] = upper ? 1.0f : 0.0f, r.normal[axis] = upper ? -1.0f : 1.0f;
        result.push_back(r);
    }
    return result;
}

double irradiance_of_lamp(const session::HostReceiver& r, float fog) {
    const Vec3 way = lamp - r.position;
    const double distance = double(glm::length(way));
    return intensity * double(glm::dot(r.normal, way)) / std::pow(distance, 3.0) *
           std::exp(-double(fog) * distance);
}

struct Mean {
    double value, error;  ///< irradiance [W/m^2], and its standard error
    double deviation(double expected) const { return (value - expected) / error; }
};

/// Irradiance at receivers, lamp included, over independent sets of light paths and receivers.
Mean irradiance(const session::HostSceneData& data, session::HostLightSettings settings, float fog = 0.0f,
                float margin = 0.0f) {
    constexpr int sets = 24, receivers = 100;  // no multiple of sixteen
    const session::HostScene host(data);
    double sum = 0.0, squares = 0.0;
    for (int set = 1; set <= sets; ++set) {
        settings.seed = std::uint64_t(set);
        const session::HostLight light(host, settings);
        const auto where = places(std::uint64_t(set), receivers, margin);
        const auto radiance = light.reflected(where);
        REQUIRE(radiance.size() == where.size());
        double mean = 0.0;
        for (std::size_t i = 0; i < where.size(); ++i)
            mean +=
                (double(radiance[i].y) * pi / reflectance + irradiance_of_lamp(where[i], fog)) / receivers;
        sum += mean / sets, squares += mean * mean / sets;
    }
    return {sum, std::sqrt((squares - sum * sum) / (sets - 1))};
}

std::string refusal(const session::HostSceneData& data, const session::HostLightSettings& settings) {
    try {
        const session::HostScene host(data);
        const session::HostLight light(host, settings);
    } catch (const core::InputError& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("walls of a host's room receive what energy demands, by each selection of VPLs",
          "[host][statistics]") {
    // Lightcuts err by 2 % of a receiver's light at most.
    const auto [selection, bias] = GENERATE(table<std::string, double>({{"all", 0.0},
                                                                        {"uniform", 0.0},
                                                                        {"lightcuts", 0.02},
                                                                        {"multidimensional_lightcuts", 0.02},
                                                                        {"stochastic_lightcuts", 0.0},
                                                                        {"light_tree", 0.0},
                                                                        {"resampling", 0.0},
                                                                        {"matrix", 0.0}}));
    CAPTURE(selection);
    const Mean found = irradiance(room(), {.paths = 256, .selection = selection});
    CAPTURE(found.value, found.error, all_light);
    CHECK(std::fabs(found.value - all_light) < 4.0 * found.error + bias * all_light);
    CHECK(found.error < 0.05 * all_light);  // else nothing would be found
}

TEST_CASE("light that a bound takes comes back by exact compensation", "[host][statistics][planted]") {
    const float fog = GENERATE(0.0f, 1.0f);
    CAPTURE(fog);
    session::HostLightSettings settings{.paths = 256, .bound = 1.0f, .compensation_steps = -1};
    const Mean exact = irradiance(room(fog), settings, fog);
    CAPTURE(exact.value, exact.error, all_light);
    CHECK(std::fabs(exact.deviation(all_light)) < 4.0);
    settings.compensation_steps = 0;  // planted: the test sees what is missing without
    CHECK(irradiance(room(fog), settings, fog).deviation(all_light) < -4.0);
}

TEST_CASE("fog that absorbs nothing leaves the walls' light as it is", "[host][statistics][planted]") {
    const float fog = 1.5f;
    const auto method = GENERATE(session::HostMethod::virtual_point_lights, session::HostMethod::ray_lights);
    CAPTURE(int(method));
    const session::HostLightSettings settings{.method = method, .paths = 256};
    CHECK(std::fabs(irradiance(room(fog), settings, fog).deviation(all_light)) < 4.0);
    session::HostSceneData absorbing = room(fog);  // planted
    absorbing.absorption = Rgb(0.3f);
    CHECK(irradiance(absorbing, settings, fog + 0.3f).deviation(all_light) < -4.0);
}

TEST_CASE("photon maps and VPLs agree in the middle of a host's walls", "[host][statistics]") {
    const Mean vpls = irradiance(room(), {.paths = 256}, 0.0f, 0.2f);
    const Mean photons =
        irradiance(room(), {.method = session::HostMethod::photon_map, .paths = 20000}, 0.0f, 0.2f);
    CAPTURE(vpls.value, vpls.error, photons.value, photons.error);
    CHECK(std::fabs(vpls.value - photons.value) < 4.0 * std::hypot(vpls.error, photons.error));
}

TEST_CASE("a host's function for shadow rays is called for them, and decides", "[host]") {
    session::HostSceneData data = room();
    std::atomic<std::size_t> queries{0};
    data.find_occluded = [&](std::span<const session::HostSegment> segments, std::span<std::uint8_t> hidden) {
        queries += segments.size();
        for (std::size_t i = 0; i < segments.size(); ++i) hidden[i] = wall(segments[i]).has_value();
    };
    const auto where = places(3, 20);
    const session::HostLightSettings settings{.paths = 64};
    const session::HostScene by_packets(data), by_rays(room());
    CHECK(session::HostLight(by_packets, settings).reflected(where) ==
          session::HostLight(by_rays, settings).reflected(where));
    CHECK(queries > 1000);
    data.find_occluded = [](auto, std::span<std::uint8_t> hidden) {
        std::fill(hidden.begin(), hidden.end(), std::uint8_t(1));
    };
    const session::HostScene dark(data);
    for (const Rgb& light : session::HostLight(dark, settings).reflected(where)) CHECK(light == Rgb(0.0f));
}

TEST_CASE("settings of a host's light that cannot be are refused by name", "[host]") {
    CHECK_THAT(refusal(room(), {.selection = "lightcut"}), ContainsSubstring("did you mean 'lightcuts'"));
    CHECK_THAT(refusal(room(), {.compensation_steps = 1}), ContainsSubstring("with a bound"));
    CHECK_THAT(refusal(room(), {.paths = 0}), ContainsSubstring("light path"));
    CHECK_THAT(refusal(room(), {.method = session::HostMethod::ray_lights, .selection = "matrix"}),
               ContainsSubstring("selection"));
    CHECK_THROWS_WITH(session::host_method("photonmap"), ContainsSubstring("did you mean 'photon_map'"));
    session::HostSceneData data = room();
    data.reflectance.pop_back();  // hits name material 1
    CHECK_THAT(refusal(data, {}), ContainsSubstring("no material 1"));
    data = room(), data.lamps.clear();
    CHECK_THAT(refusal(data, {}), ContainsSubstring("no lamp"));
    data = room(), data.reflectance[0] = Rgb(1.5f);
    CHECK_THAT(refusal(data, {}), ContainsSubstring("reflectance"));
    const session::HostScene host(room());
    const session::HostLight light(host, {.paths = 8});
    const session::HostReceiver askew{{0.5f, 0.5f, 0.0f}, {0.0f, 0.0f, 2.0f}, 1};
    CHECK_THROWS_WITH(light.reflected(std::span(&askew, 1)), ContainsSubstring("unit normal"));
    CHECK(light.reflected({}).empty());
}
