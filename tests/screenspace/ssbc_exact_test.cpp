// Steps of screen-space bias compensation against exact compensation, where all that matters is visible:
// between parallel planes in closed form, in a wedge by quadrature, in a corner by Monte Carlo.
//
// Light is constant over a pixel: an error of first order in the pixels' size, beside an edge, where light
// changes with the 2/3rd power of the distance, of order 2/3. Each result is taken at three sizes; their
// differences say how far the finest may be from the limit (grid_convergence.h), and it has to be that near.
// The error of a node is of first order in its projected solid angle, so the thresholds shrink with the
// pixels.
#include "screenspace/ssbc/ssbc.h"

#include <algorithm>
#include <array>
#include <random>

#include "tests/screenspace/ssbc_pictures.h"
#include "tests/screenspace/ssbc_wedge.h"
#include "tests/support/catch.h"
#include "tests/support/grid_convergence.h"

using namespace mote;
using namespace mote::core;
using namespace mote::screenspace;
using namespace mote::tests;

namespace {

const double pi_d = std::acos(-1.0);

double index_of(const std::array<double, 3>& results) {
    return grid_convergence_index(results, 2.0 / 3.0, 1.0);
}

SsbcSettings settings(double bound, int height) {
    SsbcSettings s;
    s.bound = float(bound);
    s.steps = 1;
    s.refinement.projected_angle = 1.0f / float(height);
    s.refinement.discontinuity_projected_angle = 0.5f / float(height);
    s.grazing_angle = 0.5f * pi;  // what is seen at a slant is known here as exactly as the rest
    return s;
}

/// Compensation of each step, as images: each compensates the one before.
std::vector<std::vector<Rgb>> terms(const TestPicture& picture, double bound, int steps) {
    std::vector<std::vector<Rgb>> result;
    std::vector<Rgb> light = picture.light;
    for (int n = 0; n < steps; ++n) {
        light = compensate(picture.surfaces, light, settings(bound, picture.surfaces.height)).compensation;
        result.push_back(light);
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
    double rms = 0.0, rms_of_exact = 0.0, bias = 0.0;
    double relative() const { return rms / rms_of_exact; }
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
            d.rms += error * error, d.rms_of_exact += e * e, d.bias += error, ++n;
        }
    REQUIRE(n > 100);
    d.rms = std::sqrt(d.rms / n), d.rms_of_exact = std::sqrt(d.rms_of_exact / n), d.bias /= n;
    return d;
}

}  // namespace

namespace {

const std::array<int, 3> wedge_sizes = {48, 96, 192};
const int wedge_steps = 4;

/// The terms of the wedge found in a picture, and by quadrature.
struct Wedge {
    Pinhole camera;
    TestPicture picture;
    std::vector<std::vector<Rgb>> found;

    explicit Wedge(int size, const std::function<void(TestPicture&)>& plant = {}, double bound = wedge_bound,
                   int steps = wedge_steps)
        : camera(wedge_camera(size)), picture(picture_of(wedge_walls, camera)) {
        if (plant) plant(picture);
        found = terms(picture, bound, steps);
    }
    Difference difference(int term, const WedgeLight& exact) const {
        return against(camera, picture, found[std::size_t(term)], exact);
    }
    /// The first n terms.
    std::vector<Rgb> sum(int n) const {
        std::vector<Rgb> result(picture.light.size(), Rgb(0.0f));
        for (int term = 0; term < n; ++term)
            for (std::size_t i = 0; i < result.size(); ++i) result[i] += found[std::size_t(term)][i];
        return result;
    }
};

const std::array<Wedge, 3>& wedges() {
    static const std::array<Wedge, 3> all = {Wedge(wedge_sizes[0]), Wedge(wedge_sizes[1]),
                                             Wedge(wedge_sizes[2])};
    return all;
}

WedgeLight exact_term(int n) {
    WedgeLight term(wedge_view, 1.0);
    for (int k = 0; k <= n; ++k) term = term.step(wedge_bound, wedge_reflectance);
    return term;
}

}  // namespace

namespace {

/// Over pixels, relative to the root mean square of all that exact compensation adds.
struct TermError {
    double rms, index, bias;  ///< of the finest picture, and what its rms may be
};

WedgeLight all_terms() {
    WedgeLight all(wedge_view, 0.0);
    for (int n = 0; n < 20; ++n) all = all + exact_term(n);
    return all;
}

TermError term_error(int n, double scale) {
    const WedgeLight exact = exact_term(n);
    std::array<double, 3> rms{};
    Difference d;
    for (std::size_t k = 0; k < 3; ++k) d = wedges()[k].difference(n, exact), rms[k] = d.rms / scale;
    INFO("term " << n + 1 << ": rms " << rms[0] << ", " << rms[1] << ", " << rms[2]);
    CHECK(rms[2] < index_of(rms));
    return {rms[2], index_of(rms), d.bias / scale};
}

/// RMS of the exact light in the finest image.
double rms_of(const WedgeLight& exact) { return wedges()[2].difference(0, exact).rms_of_exact; }

}  // namespace

TEST_CASE("In a wedge the terms of the steps are those of exact compensation", "[ssbc][exact]") {
    for (int n = 0; n < wedge_steps; ++n) {
        const TermError error = term_error(n, rms_of(exact_term(n)));
        INFO("term " << n + 1 << ": bias " << error.bias << ", tolerance " << error.index);
        CHECK(std::abs(error.bias) < error.index);  // a mean is at most the root mean square
    }
}

TEST_CASE("In a wedge errors fall from step to step as those of exact compensation do", "[ssbc][exact]") {
    const WedgeLight all = all_terms();
    const Wedge& finest = wedges()[2];
    WedgeLight exact(wedge_view, 0.0);
    double before = 1.0, tolerance = 0.0;
    for (int n = 1; n <= wedge_steps; ++n) {
        exact = exact + exact_term(n - 1);
        tolerance += term_error(n - 1, rms_of(all)).index;  // errors of terms add up at most
        const double missing = against(finest.camera, finest.picture, finest.sum(n), all).relative();
        const double expected =
            against(finest.camera, finest.picture, means(finest.camera, finest.picture, exact), all)
                .relative();
        INFO("after " << n << " steps " << missing << " of the compensation is missing, by quadrature "
                      << expected << ", tolerance " << tolerance);
        CHECK(std::abs(missing - expected) < tolerance);
        // A step multiplies by the reflectance times form factors, which are 1/2 at the edge and less
        // elsewhere.
        CHECK(expected < 0.5 * wedge_reflectance * before);
        before = expected;
    }
}

TEST_CASE("The test of the wedge finds planted errors", "[ssbc][exact][planted]") {
    const WedgeLight exact = exact_term(0);
    const double scale = rms_of(exact), tolerance = term_error(0, scale).index;
    const auto with = [&](const std::function<void(TestPicture&)>& plant, double bound = wedge_bound) {
        return std::abs(Wedge(wedge_sizes[2], plant, bound, 1).difference(0, exact).bias) / scale;
    };
    INFO("tolerance " << tolerance);
    CHECK(with({}) < tolerance);
    CHECK_FALSE(with({}, 1.05 * wedge_bound) < tolerance);
    CHECK_FALSE(with([](TestPicture& p) {
                    for (float& a : p.surfaces.area) a *= 1.05f;
                }) < tolerance);
    CHECK_FALSE(with([](TestPicture& p) {  // no division by the cosine to the viewer
                    for (std::size_t i = 0; i < p.light.size(); ++i)
                        p.surfaces.area[i] *= p.surfaces.facing[i];
                }) < tolerance);
    CHECK_FALSE(with([](TestPicture& p) {
                    for (Vec3& n : p.surfaces.normal) n = glm::normalize(n + Vec3(0.0f, 0.05f, 0.0f));
                }) < tolerance);
}

TEST_CASE("The error after N steps is more than the next term", "[ssbc][exact]") {
    // docs/errata.md, Sec. 11.1.2: beside the edge every term is near 0.45 times the one before. Printed is
    // that the error is the next term: a ratio of 1.
    const auto beside_edge = [](const Wedge& wedge, const std::vector<Rgb>& light) {
        double sum = 0.0;
        for (std::size_t i = 0; i < light.size(); ++i) {
            const Vec3 p = wedge.picture.surfaces.position[i];
            if (std::abs(p.x) < 0.4f && std::max(p.y, p.z) < 0.15f) sum += double(light[i].x);
        }
        return sum;
    };
    const auto ratio_of = [](const std::array<double, 3>& terms) {  // after N = 1, as far as they are found
        return (terms[0] + terms[1] + terms[2]) / terms[0];
    };
    std::array<double, 3> ratio{}, terms{};
    for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t n = 0; n < 3; ++n) terms[n] = beside_edge(wedges()[k], wedges()[k].found[n + 1]);
        ratio[k] = ratio_of(terms);
    }
    const Wedge& finest = wedges()[2];
    for (int n = 0; n < 3; ++n)
        terms[std::size_t(n)] = beside_edge(finest, means(finest.camera, finest.picture, exact_term(n + 1)));
    const double exact = ratio_of(terms), tolerance = index_of(ratio);
    INFO(ratio[0] << ", " << ratio[1] << ", " << ratio[2] << "; by quadrature " << exact << ", tolerance "
                  << tolerance);
    CHECK(std::abs(ratio[2] - exact) < tolerance);
    CHECK(ratio[2] - tolerance > 1.0);  // what is printed
    CHECK(ratio[2] + tolerance < 1.0 / (1.0 - 0.5 * wedge_reflectance));
}

TEST_CASE("Between parallel planes every step multiplies by the same factor", "[ssbc][exact]") {
    // A plane at distance h reflects, with s = d^2 from h^2 to S = h / sqrt(b) where the residual ends,
    //   rho / pi int max(h^2 / s^2 - b, 0) pi ds = rho (1 - h sqrt(b))^2.
    const double rho = 0.8, bound = 0.5, q = rho * std::pow(1.0 - std::sqrt(bound), 2.0);
    const Wall floor{{0, -0.5, 0}, {50, 0, 0}, {0, 0, 50}, Rgb(float(rho))};
    const Wall ceiling{{0, 0.5, 0}, {50, 0, 0}, {0, 0, 50}, Rgb(float(rho))};
    std::array<std::array<double, 3>, 3> ratio{};  // of what is found to what is right, by term and size
    for (std::size_t k = 0; k < 3; ++k) {
        const int size = 64 << k;
        const TestPicture picture =
            picture_of({floor, ceiling}, {{0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 1.6, 2 * size, size});
        const auto found = terms(picture, bound, 3);
        for (std::size_t n = 0; n < 3; ++n) {
            double sum = 0.0;
            int count = 0;
            for (std::size_t i = 0; i < picture.light.size(); ++i) {
                const Vec3 p = picture.surfaces.position[i];
                // Each term reaches 0.64 m farther, and the planes are seen beyond 0.32 m.
                if (std::abs(p.x) < 0.2f && p.z < -2.3f && p.z > -3.2f) sum += double(found[n][i].x), ++count;
            }
            REQUIRE(count > 0);
            ratio[n][k] = sum / count / std::pow(q, double(n) + 1.0);
        }
    }
    for (std::size_t n = 0; n < 3; ++n) {
        INFO("term " << n + 1 << ": " << ratio[n][0] << ", " << ratio[n][1] << ", " << ratio[n][2]);
        CHECK(std::abs(ratio[n][2] - 1.0) < index_of(ratio[n]));
    }
}

TEST_CASE("In a corner of three walls, a step is what Monte Carlo finds", "[ssbc][exact]") {
    std::vector<Wall> walls = {{{0, 0, 0}, {0, 0, 50}, {50, 0, 0}, Rgb(0.5f)},
                               {{0, 0, 0}, {50, 0, 0}, {0, 50, 0}, Rgb(0.7f)},
                               {{0, 0, 0}, {0, 50, 0}, {0, 0, 50}, Rgb(0.9f)}};
    const auto light = [](const Vec3d& p) { return 0.5 + 0.4 * std::sin(4.0 * p.x + 3.0 * p.y - 2.0 * p.z); };
    for (Wall& w : walls) w.radiance = [&](const Vec3d& p) { return float(light(p)); };
    const double bound = 2.0;

    // Over directions with density cos / pi: rho / pi int max(1 - b / G, 0) L cos dw, which is bounded.
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform;
    const std::array<int, 3> normal_axis = {1, 2, 0};
    const auto monte_carlo = [&](const Vec3d& y, int own) {
        const int n = 40000, up = normal_axis[std::size_t(own)], a = (up + 1) % 3, b = (up + 2) % 3;
        double sum = 0.0, squares = 0.0;
        for (int k = 0; k < n; ++k) {
            const double u = uniform(random), phi = 2.0 * pi_d * uniform(random);
            Vec3d w;
            w[up] = std::sqrt(1.0 - u), w[a] = std::sqrt(u) * std::cos(phi),
            w[b] = std::sqrt(u) * std::sin(phi);
            const auto distance = [&](int axis) { return w[axis] < 0.0 ? -y[axis] / w[axis] : infinity; };
            const int other = distance(a) < distance(b) ? a : b;
            const double d = distance(other);
            if (!(d < 50.0)) continue;
            const double g = w[up] * -w[other] / (d * d);
            const double value = std::max(1.0 - bound / g, 0.0) * light(y + d * w);
            sum += value, squares += value * value;
        }
        const double mean = sum / n;
        return std::pair(mean, std::sqrt((squares / n - mean * mean) / n));
    };
    // Sums over the same places of the picture at three sizes, of the finest with the errors of Monte Carlo.
    std::array<double, 3> ratio{};
    double spread = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        const int size = 64 << k;
        const Pinhole camera{{3, 2.6, 2.8}, {0.2, 0.2, 0.2}, {0, 1, 0}, std::tan(0.45), size, size};
        const TestPicture picture = picture_of(walls, camera);
        const auto found =
            compensate(picture.surfaces, picture.light, settings(bound, picture.surfaces.height))
                .compensation;
        double sum = 0.0, exact = 0.0, variance = 0.0;
        for (int y = size / 32; y < size; y += size / 16)
            for (int x = size / 32; x < size; x += size / 16) {
                const std::size_t i = picture.index(x, y);
                const Vec3d p(picture.surfaces.position[i]);
                // Beyond one radius of the bound nothing is left out; off the picture's borders all is seen.
                if (picture.wall[i] < 0 || std::max({p.x, p.y, p.z}) > 0.9) continue;
                const auto [mean, error] = monte_carlo(p, picture.wall[i]);
                const double scale = double(picture.surfaces.reflectance[i].x);
                sum += double(found[i].x), exact += scale * mean, variance += sqr(scale * error);
            }
        ratio[k] = sum / exact, spread = std::sqrt(variance) / exact;
        REQUIRE(spread < 0.01);
    }
    INFO(ratio[0] << ", " << ratio[1] << ", " << ratio[2] << " +- " << spread);
    CHECK(std::abs(ratio[2] - 1.0) < index_of(ratio) + 4.0 * spread);
}
