// Around a lamp in fog without end the mean of mote_upbp is that of its kernel: the light of single
// scattering averaged over a disc, or over the beams that pass an eye ray. In clear air beams would have
// asin(x) / x of the light, x = r / D: 16 % too much at x = 0.8.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::tests;

namespace {

constexpr double sigma_t = 0.4, albedo = 0.8, before = 2.0, pi = std::numbers::pi;
constexpr int size = 24;  // more pixels than there are light paths with beams

/// Light scattered at a point so far from a lamp of intensity 1, as seen from `t` away; isotropic.
double scattered(double distance, double t) {
    return sigma_t * albedo / (4.0 * pi * distance * distance) * std::exp(-sigma_t * (distance + t));
}

/// Radiance along a ray that passes the lamp at distance 1 and begins `before` it; midpoint rules.
template <typename Slice>
double along_ray(const Slice& slice) {
    constexpr int steps = 4000;
    constexpr double length = 40.0;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) sum += slice((i + 0.5) / steps * length) * length / steps;
    return sum;
}
double without_kernel() {
    return along_ray([](double t) { return scattered(std::hypot(1.0, t - before), t); });
}
double over_disc(double r) {
    constexpr int rings = 12, angles = 24;
    return along_ray([&](double t) {
        double sum = 0.0;
        for (int i = 0; i < rings; ++i)
            for (int k = 0; k < angles; ++k) {
                const double s = r * std::sqrt((i + 0.5) / rings), a = 2.0 * pi * (k + 0.5) / angles;
                sum += scattered(std::hypot(1.0 + s * std::cos(a), s * std::sin(a), t - before), t);
            }
        return sum / (rings * angles);
    });
}
/// With phi around the axis through the lamp: the beam passes the ray at s = cos(phi) / sin(theta), and of
/// all directions sin^3(theta) / cos(phi) dphi dt do so within dt (kernel_slices.h).
double over_beams(double r) {
    constexpr int count = 24;
    const double widest = std::asin(r);
    return along_ray([&](double t) {
        double sum = 0.0;
        for (int i = 0; i < count; ++i) {
            const double rho = std::cos(widest * (2.0 * i + 1.0 - count) / count);
            const double s = std::hypot(rho, t - before), sine = rho / s;
            sum += scattered(s, t) * s * s * sine * sine / rho * 2.0 * widest / count;
        }
        return sum / (2.0 * r);
    });
}

/// `fraction` of its first radius that a technique has with so many light paths (upbp_estimator.cpp).
RenderStatistics render(const std::string& technique, double r, double fraction, std::uint32_t passes) {
    const auto scene = scene_from(fmt::format(R"(<scene version="3.0.0"><medium type="homogeneous" id="air">
        <float name="sigma_t" value="{}"/><float name="albedo" value="{}"/></medium><emitter type="point"/>
        <sensor type="orthographic"><ref id="air"/><transform name="to_world"><scale x="1e-3" y="1e-3"/>
        <lookat origin="1, 0, {}" target="1, 0, 0" up="0, 1, 0"/></transform>
        <float name="near_clip" value="1e-7"/></sensor></scene>)",
                                              sigma_t, albedo, -before),
                                  size);
    const double unit = double(scene->bounds().radius());
    std::string others;
    for (const char* name : {"bpt", "pp3d", "pb2d", "bb1d"})
        if (name != technique) others += fmt::format(R"(<boolean name="{}" value="false"/>)", name);
    return render_statistics(
        *scene,
        *integrator_from(fmt::format(
            R"(<integrator type="mote_upbp"><string name="efforts" value="equal"/><integer name="max_depth" value="2"/>
        <float name="alpha" value="1"/><float name="radius" value="{}"/>{}</integrator>)",
            r / (unit > 0.0 ? unit : 1.0) / fraction, others)),
        {size, passes, 5});
}

}  // namespace

TEST_CASE("light around a lamp is blurred as the kernel says", "[upbp][bias]") {
    constexpr double r = 0.8;
    const auto check = [](const RenderStatistics& found, double expected, double planted) {
        check_mean_is(found, "single_scattering", expected, {planted});
        CHECK_FALSE(mean_is(found, "single_scattering", without_kernel()).passed);
    };
    check(render("pb2d", r, 1.0, 40), over_disc(r), 1.1);
    // Were kernels divided by the number of pixels, 576, and not by that of paths with beams:
    check(render("bb1d", r, 0.2, 30), over_beams(r), 500.0 / 576.0);
}
