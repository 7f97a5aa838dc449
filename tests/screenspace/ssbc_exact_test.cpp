// Steps of screen-space bias compensation against exact compensation, where all that matters is visible:
// between parallel planes in closed form, in a wedge by quadrature, in a corner by Monte Carlo.
#include "screenspace/ssbc.h"

#include <algorithm>
#include <array>
#include <random>

#include "tests/screenspace/ssbc_pictures.h"
#include "tests/screenspace/ssbc_wedge.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::screenspace;
using namespace mote::tests;

namespace {

const double pi_d = std::acos(-1.0);

SsbcSettings settings(double bound, int steps) {
    SsbcSettings s;
    s.bound = float(bound);
    s.steps = steps;
    s.refinement.projected_angle = 0.02f, s.refinement.discontinuity_projected_angle = 0.01f;
    s.grazing_angle = 0.5f * pi;  // what is seen at a slant is known here as exactly as the rest
    return s;
}

/// What one step after the other adds, as pictures.
std::vector<std::vector<Rgb>> terms(const TestPicture& picture, double bound, int steps) {
    std::vector<std::vector<Rgb>> result;
    std::vector<Rgb> before(picture.light.size(), Rgb(0.0f));
    for (int n = 1; n <= steps; ++n) {
        auto sum = compensate(picture.surfaces, picture.light, settings(bound, n)).compensation;
        result.push_back(sum);
        for (std::size_t i = 0; i < sum.size(); ++i) result.back()[i] -= before[i];
        before = std::move(sum);
    }
    return result;
}

const double wedge_bound = 1.0, wedge_reflectance = 0.9, wedge_view = 4.0;

/// A floor and a wall, seen at 45 degrees from above and turned a little, so that the edge cuts pixels in all
/// ways.
const std::vector<Wall> wedge_walls = {{{0, 0, 0}, {50, 0, 0}, {0, 0, -50}, Rgb(float(wedge_reflectance))},
                                       {{0, 0, 0}, {50, 0, 0}, {0, 50, 0}, Rgb(float(wedge_reflectance))}};
Pinhole wedge_camera(int size) { return {{0.2, 3, 3}, {0, 0, 0}, {0.1, 1, 0}, std::tan(0.45), size, size}; }

/// The mean of a function of the distance from the edge over the part of a pixel that shows one wall.
double mean_over_pixel(const WedgeLight& light, const Pinhole& camera, int x, int y, int wall) {
    const int n = 8;
    double sum = 0.0;
    int count = 0;
    for (int k = 0; k < n * n; ++k) {
        const Vec3d d = camera.direction(x + (k % n + 0.5) / n, y + (k / n + 0.5) / n);
        const auto hit = first_hit(wedge_walls, camera.eye, d);
        if (!hit || hit->wall != wall) continue;
        const Vec3d p = camera.eye + hit->t * d;
        sum += light(std::max(p.y, p.z)), ++count;
    }
    return sum / count;
}

std::vector<Rgb> means(const Pinhole& camera, const TestPicture& picture, const WedgeLight& light) {
    std::vector<Rgb> result(picture.light.size(), Rgb(0.0f));
    for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
            const std::size_t i = picture.index(x, y);
            result[i] = Rgb(float(mean_over_pixel(light, camera, x, y, picture.wall[i])));
        }
    return result;
}

struct Difference {
    double rms = 0.0, rms_of_exact = 0.0, bias = 0.0, mean_of_exact = 0.0;
    double relative() const { return rms / rms_of_exact; }
    double relative_bias() const { return bias / mean_of_exact; }
};

/// Over the pixels near the edge around which everything within two radii of the bound is visible.
Difference against(const Pinhole& camera, const TestPicture& picture, const std::vector<Rgb>& found,
                   const WedgeLight& exact) {
    Difference d;
    int n = 0;
    for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
            const std::size_t i = picture.index(x, y);
            const Vec3 p = picture.surfaces.position[i];
            if (std::abs(p.x) > 0.4f || std::max(p.y, p.z) > 0.8f) continue;
            const double e = mean_over_pixel(exact, camera, x, y, picture.wall[i]),
                         error = double(found[i].x) - e;
            d.rms += error * error, d.rms_of_exact += e * e, d.bias += error, d.mean_of_exact += e, ++n;
        }
    REQUIRE(n > 100);
    d.rms = std::sqrt(d.rms / n), d.rms_of_exact = std::sqrt(d.rms_of_exact / n);
    return d;
}

}  // namespace

TEST_CASE("In a wedge, the terms of the steps are those of exact compensation", "[ssbc][exact]") {
    // The error is that of light which is constant over a pixel: of first order in the pixels' size. Light
    // rises towards the edge, and each term more steeply than the one before.
    const int sizes[2] = {48, 96};
    Difference differences[2][4];
    for (int k = 0; k < 2; ++k) {
        const Pinhole camera = wedge_camera(sizes[k]);
        const TestPicture picture = picture_of(wedge_walls, camera);
        const auto found = terms(picture, wedge_bound, 4);
        WedgeLight exact(wedge_view, 1.0);
        for (int n = 0; n < 4; ++n) {
            exact = exact.step(wedge_bound, wedge_reflectance);
            differences[k][n] = against(camera, picture, found[std::size_t(n)], exact);
        }
    }
    for (int n = 0; n < 4; ++n) {
        const Difference &coarse = differences[0][n], &fine = differences[1][n];
        INFO("term " << n + 1 << ": relative rms " << coarse.relative() << " and " << fine.relative()
                     << ", bias " << coarse.relative_bias() << " and " << fine.relative_bias());
        CHECK(fine.relative() < 0.7 * coarse.relative());
        CHECK(std::abs(fine.relative_bias()) < 0.7 * std::max(0.02, std::abs(coarse.relative_bias())));
    }
    CHECK(differences[1][0].relative() < 0.03);
    CHECK(std::abs(differences[1][0].relative_bias()) < 0.01);
    CHECK(differences[1][1].relative() < 0.08);
}

TEST_CASE("In a wedge, errors fall from step to step as those of exact compensation do", "[ssbc][exact]") {
    const Pinhole camera = wedge_camera(96);
    const TestPicture picture = picture_of(wedge_walls, camera);
    const int steps = 4;
    std::vector<WedgeLight> exact = {
        WedgeLight(wedge_view, 0.0)};  // after n steps, and in the end after many
    WedgeLight term(wedge_view, 1.0);
    for (int n = 1; n <= 20; ++n) {
        term = term.step(wedge_bound, wedge_reflectance);
        exact.push_back(exact.back() + term);
    }
    double before = 1.0;
    for (int n = 1; n <= steps; ++n) {
        const auto found = compensate(picture.surfaces, picture.light, settings(wedge_bound, n)).compensation;
        const double missing = against(camera, picture, found, exact.back()).relative();
        const double expected =
            against(camera, picture, means(camera, picture, exact[std::size_t(n)]), exact.back()).relative();
        INFO("after " << n << " steps " << missing << " of the compensation is missing, by quadrature "
                      << expected);
        // The margin: the rms errors of the terms above times their sizes, added up.
        CHECK(missing == Approx(expected).margin(0.05));
        CHECK(missing < 0.45 * before + 0.03);  // reflectance times the form factor at the edge, 1/2
        before = missing;
    }
}

TEST_CASE("The test of the wedge finds planted errors", "[ssbc][exact][planted]") {
    const Pinhole camera = wedge_camera(96);
    const TestPicture right = picture_of(wedge_walls, camera);
    const WedgeLight exact = WedgeLight(wedge_view, 1.0).step(wedge_bound, wedge_reflectance);
    const auto bias = [&](const TestPicture& picture, double bound) {
        const auto found = compensate(picture.surfaces, picture.light, settings(bound, 1)).compensation;
        return std::abs(against(camera, picture, found, exact).relative_bias());
    };
    CHECK(bias(right, wedge_bound) < 0.01);
    CHECK_FALSE(bias(right, 1.05 * wedge_bound) < 0.01);
    TestPicture wrong = right;
    for (float& a : wrong.surfaces.area) a *= 1.03f;
    CHECK_FALSE(bias(wrong, wedge_bound) < 0.01);
    wrong = right;
    for (std::size_t i = 0; i < wrong.light.size(); ++i)  // no division by the cosine to the viewer
        wrong.surfaces.area[i] *= wrong.surfaces.facing[i];
    CHECK_FALSE(bias(wrong, wedge_bound) < 0.01);
    wrong = right;
    for (Vec3& n : wrong.surfaces.normal) n = glm::normalize(n + Vec3(0.0f, 0.05f, 0.0f));
    CHECK_FALSE(bias(wrong, wedge_bound) < 0.01);
}

TEST_CASE("The error after N steps is more than the next term", "[ssbc][exact]") {
    // docs/errata.md, Sec. 11.1.2: beside the edge every term is near 0.45 times the one before.
    WedgeLight next(wedge_view, 1.0), left_out(wedge_view, 0.0);
    for (int n = 1; n <= 2; ++n) next = next.step(wedge_bound, wedge_reflectance);  // after N = 1
    for (WedgeLight term = next; term(1e-3) > 1e-6; term = term.step(wedge_bound, wedge_reflectance))
        left_out = left_out + term;
    CHECK(left_out(1e-3) > 1.5 * next(1e-3));
    CHECK(left_out(1e-3) < next(1e-3) / (1.0 - 0.45));
}

TEST_CASE("Between parallel planes every step multiplies by the same factor", "[ssbc][exact]") {
    // A plane at distance h reflects, with s = d^2 from h^2 to S = h / sqrt(b) where the residual ends,
    //   rho / pi int max(h^2 / s^2 - b, 0) pi ds = rho (1 - h sqrt(b))^2.
    const double rho = 0.8, bound = 0.5, q = rho * std::pow(1.0 - std::sqrt(bound), 2.0);
    const Wall floor{{0, -0.5, 0}, {50, 0, 0}, {0, 0, 50}, Rgb(float(rho))};
    const Wall ceiling{{0, 0.5, 0}, {50, 0, 0}, {0, 0, 50}, Rgb(float(rho))};
    const Pinhole camera{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 1.6, 192, 128};
    const TestPicture picture = picture_of({floor, ceiling}, camera);
    const auto found = terms(picture, bound, 3);
    for (int n = 0; n < 3; ++n) {
        double sum = 0.0;
        int count = 0;
        for (std::size_t i = 0; i < picture.light.size(); ++i) {
            const Vec3 p =
                picture.surfaces.position[i];  // within 0.6 m of it the other plane matters to 0.64 m
            if (std::abs(p.x) < 0.2f && p.z < -1.3f && p.z > -1.7f)
                sum += double(found[std::size_t(n)][i].x), ++count;
        }
        INFO("term " << n + 1 << " over " << count << " pixels");
        REQUIRE(count > 20);
        CHECK(sum / count == Approx(std::pow(q, n + 1)).epsilon(0.03 * (n + 1)));
    }
}

TEST_CASE("In a corner of three walls, a step is what Monte Carlo finds", "[ssbc][exact]") {
    std::vector<Wall> walls = {{{0, 0, 0}, {0, 0, 50}, {50, 0, 0}, Rgb(0.5f)},
                               {{0, 0, 0}, {50, 0, 0}, {0, 50, 0}, Rgb(0.7f)},
                               {{0, 0, 0}, {0, 50, 0}, {0, 0, 50}, Rgb(0.9f)}};
    const auto light = [](const Vec3d& p) { return 0.5 + 0.4 * std::sin(4.0 * p.x + 3.0 * p.y - 2.0 * p.z); };
    for (Wall& w : walls) w.radiance = [&](const Vec3d& p) { return float(light(p)); };
    const Pinhole camera{{3, 2.6, 2.8}, {0.2, 0.2, 0.2}, {0, 1, 0}, std::tan(0.45), 128, 128};
    const TestPicture picture = picture_of(walls, camera);
    const double bound = 2.0, radius = 1.0 / std::sqrt(bound);
    const auto found = compensate(picture.surfaces, picture.light, settings(bound, 1)).compensation;

    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(0.0, radius);
    const auto monte_carlo = [&](const Vec3d& y, int own) {
        const int n = 20000;
        double sum = 0.0, squares = 0.0;
        for (int k = 0; k < n; ++k)
            for (int w = 0; w < 3; ++w) {
                if (w == own) continue;
                // A square on the other wall's axes, from the corner of the room or one radius before y.
                Vec3d z(0.0), low = glm::max(y - radius, Vec3d(0.0));
                const int axis = w == 0 ? 1 : w == 1 ? 2 : 0, own_axis = own == 0 ? 1 : own == 1 ? 2 : 0;
                double area = 1.0;
                for (int c = 0; c < 3; ++c)
                    if (c != axis) {
                        const double width = y[c] + radius - low[c];
                        z[c] = low[c] + width * uniform(random) / radius, area *= width;
                    }
                const double d2 = glm::dot(z - y, z - y), g = z[own_axis] * y[axis] / (d2 * d2);
                const double value = std::max(g - bound, 0.0) * area * light(z);
                sum += value, squares += value * value;
            }
        const double mean = sum / n;
        return std::pair(mean, std::sqrt((squares / n - mean * mean / 2.0) / n));
    };
    int checked = 0;
    for (int y = 4; y < 128; y += 7)
        for (int x = 4; x < 128; x += 7) {
            const std::size_t i = picture.index(x, y);
            const Vec3d p(picture.surfaces.position[i]);
            std::array<double, 3> sorted = {p.x, p.y, p.z};
            std::sort(sorted.begin(), sorted.end());
            if (picture.wall[i] < 0 || sorted[1] < 0.08 || sorted[1] > 0.6 || sorted[2] > 0.9) continue;
            const auto [mean, error] = monte_carlo(p, picture.wall[i]);
            const double scale = double(picture.surfaces.reflectance[i].x) / pi_d;
            INFO(x << ", " << y << " at " << p.x << ' ' << p.y << ' ' << p.z);
            // Beyond the first two rows of pixels the sum is right to 2 %, plus what light varies over a
            // pixel.
            CHECK(std::abs(double(found[i].x) - scale * mean) < scale * (4.5 * error + 0.03 * mean + 0.003));
            ++checked;
        }
    CHECK(checked > 15);
}
