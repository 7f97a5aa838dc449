// Points in media, and buffers that see them, against closed forms and integrals along rays.
#include "gathering/stored_light/fog_radiosity.h"

#include "core/objects/error.h"
#include "media/henyey_greenstein.h"
#include "media/homogeneous_medium.h"
#include "media/phase_functions.h"
#include "tests/gathering/micro_scenes.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::gathering;

namespace {

const Bounds3 cube{Vec3(-1.0f), Vec3(1.0f)};

std::shared_ptr<Medium> fog(const Rgb& sigma_t, const Rgb& sigma_s, float g = 0.0f) {
    return std::make_shared<media::HomogeneousMedium>(sigma_t, sigma_s, Rgb(0.0f),
                                                      std::make_shared<media::HenyeyGreensteinPhase>(g));
}

/// Vacuum outside of a ball around the origin; infinity: the medium is everywhere.
MediumStateAt ball_of(const Medium& medium, float radius) {
    return [&medium, radius](const Vec3& p) {
        MediumState state;
        if (glm::length(p) < radius) state.set_outside(&medium);
        return state;
    };
}

/// Points of a medium in the cube, without surfaces.
struct Fog {
    Fog(const MediumStateAt& state_at, std::uint32_t count, HemisphereMap map, float cut = 4.0f,
        const Surfels& surfels = {}, const Bounds3& box = cube, std::uint32_t side = 16)
        : Fog(sample_media(box, std::max(4 * count, 32768u), 7, state_at), count, map, cut, surfels, side) {}
    Fog(MediumSamples samples, std::uint32_t count, HemisphereMap map, float cut, const Surfels& surfels,
        std::uint32_t side)
        : extinction(std::move(samples.extinction)),
          points(draw_volume_points(samples, count, 11)),
          hierarchy(points),
          surfaces(surfels),
          micro(surfaces, {.side = side, .map = map}),
          buffers(micro, hierarchy, extinction, cut) {}

    /// Sum over each receiver's texels, weighted as the map requires.
    std::vector<Rgb> gather(std::span<const MicroReceiver> receivers, const VolumeLight& light,
                            const Rgb& environment, const Rgb& of_surfaces = Rgb(0.0f)) const {
        const NodeRadiance none(surfaces, std::vector<Rgb>(surfaces.points(), of_surfaces),
                                std::vector<Rgb>(surfaces.points(), of_surfaces));
        const std::size_t each = buffers.texels_each();
        std::vector<Rgb> radiance(receivers.size() * each), sums;
        FogScratch scratch;
        buffers.render(receivers, none, light, radiance, scratch, environment);
        const HemisphereTexels& texels = micro.texels();
        const auto weights =
            texels.map() == HemisphereMap::cosine ? texels.cosine_weights() : texels.solid_angles();
        for (std::size_t i = 0; i < receivers.size(); ++i)
            sums.push_back(weighted(std::span<const Rgb>(radiance).subspan(i * each, each), weights));
        return sums;
    }
    VolumeLight evenly_lit(const Rgb& fluence) const {
        return {hierarchy, points, std::vector<Fluence>(points.size(), Fluence{fluence, Vec3(0.0f)})};
    }

    ExtinctionGrid extinction;
    VolumePoints points;
    VolumeHierarchy hierarchy;
    PointHierarchy surfaces;
    MicroBuffers micro;
    FogBuffers buffers;
};

std::vector<MicroReceiver> receivers_in_cube(int count, float half) {
    std::vector<MicroReceiver> receivers;
    Rng rng(3);
    for (int i = 0; i < count; ++i) {
        const Vec3 u(rng.next_float(), rng.next_float(), rng.next_float());
        receivers.push_back(
            {half * (2.0f * u - 1.0f), tests::turned_frame(square_to_sphere(rng.next_vec2()), rng)});
    }
    return receivers;
}

/// Mean and root mean square of gathered / whole - 1 in a furnace, and of the mean of each channel.
struct FurnaceErrors {
    double mean = 0.0, rms = 0.0;
};
FurnaceErrors furnace_errors(std::uint32_t count, HemisphereMap map, const Rgb& sigma, float g = 0.0f,
                             float cut = 4.0f) {
    const auto medium = fog(sigma, sigma, g);
    const Fog scene(ball_of(*medium, infinity), count, map, cut);
    const auto receivers = receivers_in_cube(48, 0.95f);
    const double whole = (map == HemisphereMap::cosine ? 1.0 : 2.0) * M_PI;
    FurnaceErrors e;
    for (const Rgb& sum : scene.gather(receivers, scene.evenly_lit(Rgb(4.0f * pi)), Rgb(1.0f)))
        for (int c = 0; c < 3; ++c) {
            const double off = double(sum[c]) / whole - 1.0;
            e.mean += off / 144.0, e.rms += off * off / 144.0;
        }
    e.rms = std::sqrt(e.rms);
    return e;
}

}  // namespace

// In a furnace of radiance 1 the light at every point is 4 pi, and what is scattered along a ray makes up for
// what is lost on it. Points' balls reach beyond the cube by up to their radius (3 / 4 pi)^(1/3) 2 N^(-1/3):
// on the way to its border a ray misses 3/16 of that of its light at sigma 1 (the part of a ball beyond a
// plane), and a fifth more where it meets it at a slant.
TEST_CASE("in a furnace fog and what is behind it add up to 1", "[fog]") {
    const Rgb sigma(0.5f, 0.8f, 1.2f);
    for (const HemisphereMap map : {HemisphereMap::cosine, HemisphereMap::equal_area}) {
        std::vector<double> counts, errors;
        for (const std::uint32_t count : {2000u, 8000u, 32000u}) {
            const FurnaceErrors e = furnace_errors(count, map, sigma, 0.0f, 0.1f);
            const double radius = std::cbrt(3.0 * 8.0 / (4.0 * M_PI * count));
            CAPTURE(count, e.mean, e.rms, radius);
            CHECK(std::fabs(e.mean) < 1.2 * radius * 3.0 / 16.0);
            counts.push_back(double(count)), errors.push_back(e.rms);
        }
        // The border's error falls as N^(-1/3) in the end, a little slower where balls are no longer small.
        CAPTURE(errors);
        CHECK(tests::exponent(counts, errors) < -0.27);
        CHECK(errors.back() < 0.025);
    }
    // Where all directions are alike the phase function does not matter.
    const double even = furnace_errors(4000, HemisphereMap::cosine, sigma).mean,
                 forward = furnace_errors(4000, HemisphereMap::cosine, sigma, 0.7f).mean;
    CHECK(even == forward);
    // Planted: without the transmittance, without what fog scatters.
    const auto medium = fog(sigma, sigma);
    const Fog scene(ball_of(*medium, infinity), 4000, HemisphereMap::cosine);
    const auto receivers = receivers_in_cube(8, 0.9f);
    for (const Rgb& sum : scene.gather(receivers, scene.evenly_lit(Rgb(0.0f)), Rgb(1.0f)))
        CHECK(double(sum.y) < 0.8 * M_PI);
}

// A ball of medium, evenly lit: along a chord of length s it sends sigma_s / (4 pi sigma_t) (1 - exp(-sigma_t
// s)) of the fluence, here integrated over the cone that it covers. The transmittance is that of a texel's
// middle: with 16 x 16 texels the ball is 7 across, and where it is 3.5 optical depths thick its light comes
// from the near side of every texel's rays, from a side of which 1 / 30 is wrong; with half the texels twice
// that.
TEST_CASE("a ball of fog shines as its integral along rays says", "[fog]") {
    const Rgb sigma_t(0.4f, 1.0f, 2.5f), sigma_s(0.4f, 0.6f, 0.5f);
    const float radius = 0.7f, distance = 1.5f;
    const auto medium = fog(sigma_t, sigma_s);
    Vec3d expected(0.0);
    const double largest = std::asin(double(radius / distance));
    constexpr int steps = 4000;
    for (int i = 0; i < steps; ++i) {
        const double angle = largest * (i + 0.5) / steps, off = double(distance) * std::sin(angle);
        const double chord = 2.0 * std::sqrt(double(radius) * double(radius) - off * off);
        const double ring = 2.0 * M_PI * std::sin(angle) * std::cos(angle) * largest / steps;
        for (int c = 0; c < 3; ++c)
            expected[c] += ring * double(sigma_s[c] / sigma_t[c]) / (4.0 * M_PI) *
                           (1.0 - std::exp(-double(sigma_t[c]) * chord));
    }
    std::vector<MicroReceiver> receivers;
    std::vector<double> cosines;
    Rng rng(5);
    for (int i = 0; i < 64; ++i) {
        const Vec3 from = square_to_sphere(rng.next_vec2());
        // Turned aside, so that texels fall on the ball here and there; its light falls with the cosine.
        const Vec3 normal = Frame(-from).to_world(square_to_cone(rng.next_vec2(), 1.0f - std::cos(0.5f)));
        receivers.push_back({distance * from, tests::turned_frame(normal, rng)});
        cosines.push_back(double(glm::dot(normal, -from)));
    }
    const auto mean_error = [&](std::uint32_t side) {
        const Fog scene(ball_of(*medium, radius), 9600, HemisphereMap::cosine, 0.5f, {}, cube, side);
        const auto sums = scene.gather(receivers, scene.evenly_lit(Rgb(1.0f)), Rgb(0.0f));
        Vec3d mean(0.0);
        for (std::size_t i = 0; i < sums.size(); ++i)
            mean += Vec3d(Vec3(sums[i])) / (cosines[i] * double(sums.size()));
        return mean / expected - 1.0;
    };
    const Vec3d coarse = mean_error(8), fine = mean_error(16);
    CAPTURE(coarse.x, coarse.y, coarse.z, fine.x, fine.y, fine.z);
    CHECK(std::fabs(fine.x) < 0.01);
    CHECK(std::fabs(fine.y) < 0.02);
    CHECK(std::fabs(fine.z) < 0.045);
    CHECK(coarse.z > 1.8 * fine.z);
    CHECK(fine.z > 2.0 * fine.x);
}

TEST_CASE("points are drawn without bias, in proportion to what scatters", "[fog]") {
    // Twice as dense on one side; nothing beyond x + y > 1.
    const auto thin = fog(Rgb(1.0f), Rgb(0.5f)), dense = fog(Rgb(2.0f), Rgb(1.0f));
    const auto state_at = [&](const Vec3& p) {
        MediumState state;
        if (p.x + p.y < 1.0f) state.set_outside(p.x < 0.0f ? thin.get() : dense.get());
        return state;
    };
    // Integral of 1 + z^2 over either side: areas 2 and 1.5 (the corner is cut off), times 2 + 2 / 3.
    const double expected[2] = {(2.0) * 8.0 / 3.0, 1.5 * 8.0 / 3.0};
    double sum[2] = {}, squares[2] = {}, share[2] = {};
    constexpr int runs = 24;
    for (int run = 0; run < runs; ++run) {
        const MediumSamples samples = sample_media(cube, 4096, 100 + std::uint64_t(run), state_at);
        const VolumePoints points = draw_volume_points(samples, 1000, 5 + std::uint64_t(run));
        CHECK(std::fabs(double(points.size()) - 1000.0) <= 1.0);
        double of_run[2] = {};
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Vec3& p = points.positions[i];
            CHECK(p.x + p.y < 1.0f);
            of_run[p.x > 0.0f] += double(points.volumes[i]) * (1.0 + double(p.z * p.z));
            share[p.x > 0.0f] += 1.0 / (1000.0 * runs);
        }
        for (int s = 0; s < 2; ++s) sum[s] += of_run[s] / runs, squares[s] += of_run[s] * of_run[s] / runs;
    }
    for (int s = 0; s < 2; ++s) {
        const double error = std::sqrt((squares[s] - sum[s] * sum[s]) / (runs - 1));
        CAPTURE(s, sum[s], expected[s], error);
        CHECK(std::fabs(sum[s] - expected[s]) < 4.0 * error);
        CHECK(error < 0.01 * expected[s]);  // 4 % would be seen
    }
    CHECK(std::fabs(share[1] / share[0] - 1.5) < 0.05);  // 1.5 * 2 to 2
    CHECK(draw_volume_points(sample_media(cube, 4096, 1, ball_of(*thin, -1.0f)), 100, 1).size() == 0);
}

TEST_CASE("a point scatters light as its phase function has it", "[fog]") {
    const Vec3 travels = glm::normalize(Vec3(1, 2, -1));
    for (const float g : {0.0f, 0.6f, -0.4f}) {
        const auto medium = fog(Rgb(1.0f), Rgb(0.8f), g);
        VolumePoints one;
        one.positions = {Vec3(0.0f)}, one.volumes = {0.5f}, one.sigma_s = {Rgb(0.8f)};
        one.states.resize(1), one.states[0].set_outside(medium.get());
        const VolumeHierarchy hierarchy(one);
        Fluence parallel, mixed;
        parallel.add(Rgb(2.0f), -travels, 1.5f);  // 3 W/m^2
        mixed.add(Rgb(2.0f), -travels, 1.0f), mixed.add(Rgb(2.0f), travels, 0.5f);
        const VolumeLight light(hierarchy, one, std::span(&parallel, 1)),
            both(hierarchy, one, std::span(&mixed, 1));
        const media::HenyeyGreensteinPhase phase(g);
        double power = 0.0, flow = 0.0;
        constexpr int n = 4000;
        for (int i = 0; i < n; ++i) {
            const float z = 1.0f - (2.0f * float(i) + 1.0f) / float(n);
            const Vec3 w = Frame(travels).to_world(Vec3(std::sqrt(1.0f - z * z), 0.0f, z));
            const double expected = 0.5 * 0.8 * 3.0 * double(phase.eval(w, -travels).x);
            CHECK(std::fabs(double(light.intensity(0, w).x) - expected) < 2e-5 * expected);
            power += double(both.intensity(0, w).x) * 4.0 * M_PI / n;
            flow += double(both.intensity(0, w).x) * double(z) * 4.0 * M_PI / n;
        }
        // Power and flow of two opposite directions: 3 and (2 - 1) g.
        CHECK(std::fabs(power / (0.5 * 0.8 * 3.0) - 1.0) < 1e-4);
        CHECK(std::fabs(flow / (0.5 * 0.8) - double(g)) < 1e-3);
    }
}

TEST_CASE("surfaces hide the fog behind them, and fog dims surfaces", "[fog]") {
    const Rgb sigma(0.7f);
    const auto medium = fog(sigma, sigma);
    // A sphere of radius 0.5 around the receiver, of radiance 1.
    Surfels shell = tests::sphere_of_points(6000);
    for (Vec3& p : shell.positions) p = 0.25f * (p - Vec3(1, 2, 3));
    shell.radius *= 0.25f, shell.area *= 0.0625;
    const Fog scene(ball_of(*medium, infinity), 20000, HemisphereMap::cosine, 4.0f, shell,
                    {Vec3(-0.6f), Vec3(0.6f)});
    std::vector<MicroReceiver> receivers(16);
    Rng rng(2);
    for (MicroReceiver& r : receivers)
        r = {Vec3(0.0f), tests::turned_frame(square_to_sphere(rng.next_vec2()), rng)};
    const auto sum = [&](float fluence, float surface) {
        double mean = 0.0;
        for (const Rgb& e : scene.gather(receivers, scene.evenly_lit(Rgb(fluence)), Rgb(1e3f), Rgb(surface)))
            mean += double(e.x) / (M_PI * double(receivers.size()));
        return mean;
    };
    const double through = std::exp(-0.7 * 0.5);
    // The discs of the shell are tangent to it, up to 0.01 beyond. Some 6000 points lie within; the nearest
    // count most, as if it were 600: 4 %.
    CHECK(std::fabs(sum(0.0f, 1.0f) / through - 1.0) < 0.02);
    CHECK(std::fabs(sum(4.0f * pi, 0.0f) / (1.0 - through) - 1.0) < 0.04);
    CHECK(std::fabs(sum(4.0f * pi, 1.0f) - 1.0) < 0.02);
}

TEST_CASE("fog at the extremes", "[fog]") {
    const auto medium = fog(Rgb(1.0f), Rgb(1.0f)), thick = fog(Rgb(1e4f), Rgb(1e4f));
    const auto receivers = receivers_in_cube(6, 1.5f);  // some beyond the box
    for (const Medium* m : {medium.get(), thick.get()})
        for (const std::uint32_t count : {0u, 1u, 2u, 1000u}) {
            const Fog scene(ball_of(*m, infinity), count, HemisphereMap::equal_area);
            CHECK(scene.points.size() <= count + 1);
            std::vector<MicroReceiver> all = receivers;
            for (std::size_t i = 0; i < std::min<std::size_t>(scene.points.size(), 4); ++i)
                all.push_back({scene.points.positions[i], Frame(Vec3(0, 1, 0))});
            for (const Rgb& e : scene.gather(all, scene.evenly_lit(Rgb(1.0f)), Rgb(1.0f)))
                CHECK((std::isfinite(e.x) && e.x >= 0.0f));
        }
    // Nothing anywhere: what is behind is seen.
    const Fog nothing(ball_of(*medium, -1.0f), 100, HemisphereMap::cosine);
    for (const Rgb& e : nothing.gather(receivers, nothing.evenly_lit(Rgb(1.0f)), Rgb(1.0f)))
        CHECK(std::fabs(double(e.x) - M_PI) < 1e-5);
    CHECK_THROWS_AS(FogBuffers(nothing.micro, nothing.hierarchy, nothing.extinction, 0.0f), InputError);
    const Fog some(ball_of(*medium, infinity), 100, HemisphereMap::cosine);
    CHECK_THROWS_AS(VolumeLight(some.hierarchy, some.points, {}), InputError);
    std::vector<Fluence> wrong(some.points.size());
    wrong[3].amount.y = std::nanf("");
    CHECK_THROWS_AS(VolumeLight(some.hierarchy, some.points, wrong), InputError);
}
