// MIS weights of subpaths in a medium against brute force: every technique's joint density is multiplied up
// from positions, angles and transmittances alone, for paths of up to six edges; what is compared are the
// weights that the estimator computes from two subpaths.
#include <cmath>
#include <numbers>
#include <vector>

#include "core/math/random.h"
#include "integrators/bidirectional/beam.h"
#include "integrators/bidirectional/subpath.h"
#include "media/phase_functions.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::integrators;

namespace {

constexpr float g = 0.4f, sigma_t = 0.7f;

struct Points {
    std::vector<Vec3> x;  ///< x[0] on a point light, the last on the lens
    int size() const { return int(x.size()); }
    Vec3 towards(int i, int j) const { return glm::normalize(x[std::size_t(j)] - x[std::size_t(i)]); }
    double square(int i, int j) const {
        const Vec3d d = Vec3d(x[std::size_t(j)]) - Vec3d(x[std::size_t(i)]);
        return glm::dot(d, d);
    }
    double tau(int i) const { return std::exp(-double(sigma_t) * std::sqrt(square(i - 1, i))); }
};

Points random_points(int n, Rng& rng) {
    Points points;
    for (int i = 0; i < n; ++i) points.x.push_back({rng.next_float(), rng.next_float(), rng.next_float()});
    return points;
}

double phase_pdf(const Vec3& from, const Vec3& at, const Vec3& to) {
    const double c = glm::dot(Vec3d(glm::normalize(at - from)), Vec3d(glm::normalize(to - at)));
    const double d = 1.0 + double(g) * double(g) - 2.0 * double(g) * c;
    return (1.0 - double(g) * double(g)) / (4.0 * std::numbers::pi * d * std::sqrt(d));
}

/// Joint densities of all techniques, with nothing left out.
class BruteForce {
  public:
    BruteForce(const Points& points, const MergeSettings& settings, bool with_sine)
        : points_(points), settings_(settings), with_sine_(with_sine) {}

    /// Density of x_i, sampled from x_{i-1}, by area or volume.
    double from_light(int i) const {
        if (i == 0) return 1.0;
        return direction(i, i - 1, i - 2) / points_.square(i, i - 1) * points_.tau(i) * sigma(i);
    }
    double from_eye(int i) const {
        const int n = points_.size();
        if (i == n - 1) return 1.0;
        return direction(i, i + 1, i + 2) / points_.square(i, i + 1) * points_.tau(i + 1) * sigma(i);
    }
    double connection(int s) const {
        double p = 1.0;
        for (int i = 0; i < points_.size(); ++i) p *= i < s ? from_light(i) : from_eye(i);
        return p;
    }
    double merge(int k, Merge technique) const {
        double p = settings_.light_subpaths[std::size_t(technique)];
        for (int i = 0; i < points_.size(); ++i) p *= i < k ? from_light(i) : i > k ? from_eye(i) : 1.0;
        const double r = settings_.radius[std::size_t(technique)], pi = std::numbers::pi;
        const double light = from_light(k), eye = from_eye(k);
        // A beam: not the distance's density, but for short ones the probability to come so far.
        const auto beam = [&](double density, BeamLength length, double tau) {
            const double passing = density / (double(sigma_t) * tau);
            return length == BeamLength::short_beam ? passing * tau : passing;
        };
        const double light_beam = beam(light, settings_.light_beams, points_.tau(k));
        const double eye_beam = beam(eye, settings_.eye_beams, points_.tau(k + 1));
        const Vec3d a(points_.towards(k, k - 1)), b(points_.towards(k, k + 1));
        if (technique == Merge::point_point_3d) return p * light * eye * 4.0 / 3.0 * pi * r * r * r;
        if (technique == Merge::point_beam_2d) return p * light * eye_beam * pi * r * r;
        if (technique == Merge::beam_beam_1d)
            return p * light_beam * eye_beam * 2.0 * r * (with_sine_ ? glm::length(glm::cross(a, b)) : 1.0);
        return 0.0;
    }

  private:
    double sigma(int i) const { return i > 0 && i + 1 < points_.size() ? double(sigma_t) : 1.0; }
    /// Per solid angle of the direction from x_j to x_i, after x_h.
    double direction(int i, int j, int h) const {
        if (j == 0) return 1.0 / (4.0 * std::numbers::pi);
        if (j == points_.size() - 1) return 0.6;
        return phase_pdf(points_.x[std::size_t(h)], points_.x[std::size_t(j)], points_.x[std::size_t(i)]);
    }
    const Points& points_;
    const MergeSettings& settings_;
    bool with_sine_;
};

/// The subpath of the first `count` vertices from one end, as SubpathWalk makes it.
Subpath subpath(const Points& points, int count, bool from_light, const MergeSettings& settings,
                const PhaseFunction& phase, Heuristic heuristic) {
    Subpath path;
    path.heuristic = heuristic, path.from_light = from_light, path.merging = settings;
    const auto at = [&](int i) { return from_light ? i : points.size() - 1 - i; };
    const TransportMode mode = from_light ? TransportMode::power : TransportMode::radiance;
    for (int k = 0; k < count; ++k) {
        PathVertex v;
        v.scattering.position = points.x[std::size_t(at(k))];
        v.start = from_light && k == 0;
        if (k == 0) {
            path.vertices.push_back(v);
            continue;
        }
        v.scattering.wo = points.towards(at(k), at(k - 1)), v.scattering.phase = &phase;
        v.distance_squared = points.square(at(k), at(k - 1));
        v.edge = points.tau(from_light ? k : at(k) + 1);
        double pdf = from_light ? 1.0 / (4.0 * std::numbers::pi) : 0.6;
        if (k >= 2) pdf = double(phase.pdf_solid_angle(path.vertices.back().scattering.wo, -v.scattering.wo));
        v.density = pdf / v.distance_squared * v.edge;
        if (k == 1) v.connection = 0.0;  // no light is sampled, and no path joined to the lens
        MediumCoefficients coefficients;
        coefficients.sigma_t = coefficients.sigma_s = Rgb(sigma_t);
        set_merges(path, coefficients, v);
        path.vertices.push_back(v);
        if (k >= 2)
            path.vertices.back().others = path.others_before(
                std::size_t(k), density_of_previous(path, std::size_t(k) - 1, -v.scattering.wo, mode, false));
    }
    return path;
}

double weight_of_connection(const Points& points, const Subpath& light, const Subpath& eye) {
    const std::size_t s = light.size(), t = eye.size();
    const PathVertex &y = light.vertices[s - 1], &z = eye.vertices[t - 1];
    const Vec3 wi = points.towards(int(s), int(s) - 1);
    const double d2 = points.square(int(s), int(s) - 1), tau = points.tau(int(s));
    const double to_light = double(z.scattering.pdf_solid_angle(wi, TransportMode::radiance)) / d2 * tau;
    const double to_eye = double(y.scattering.pdf_solid_angle(-wi, TransportMode::power)) / d2 * tau;
    const double before_y = density_of_previous(light, s - 1, -wi, TransportMode::power, false);
    const double before_z = density_of_previous(eye, t - 1, wi, TransportMode::radiance, false);
    return 1.0 / (1.0 + light.others(s - 1, to_light, before_y, tau, wi) +
                  eye.others(t - 1, to_eye, before_z, tau, wi));
}

/// Both subpaths end at x_k.
double weight_of_merge(const Subpath& light, const Subpath& eye, Merge technique,
                       const MergeSettings& settings) {
    const PathVertex &y = light.vertices.back(), &z = eye.vertices.back();
    const std::size_t i = light.size() - 1, j = eye.size() - 1;
    const double kernel = merge_kernel(
        technique,
        {false, true, double(sigma_t), y.edge, z.edge, sine_between(y.scattering.wo, z.scattering.wo)},
        settings);
    MergedVertex m;
    m.from_light = y.density, m.from_eye = z.density;
    m.connection_light = light.technique(i, y, true), m.connection_eye = eye.technique(j, z, true);
    m.before_light =
        light.through(i - 1, density_of_previous(light, i, z.scattering.wo, TransportMode::power, false), y);
    m.before_eye =
        eye.through(j - 1, density_of_previous(eye, j, y.scattering.wo, TransportMode::radiance, false), z);
    m.merges = eye.merges(z, y.edge, y.scattering.wo);
    return kernel * merge_weight_over_kernel(eye.heuristic, m, kernel);
}

/// Largest difference of any weight from brute force with `of_brute_force`.
double largest_difference(Heuristic heuristic, const MergeSettings& settings,
                          const MergeSettings& of_brute_force, bool with_sine = true) {
    Rng rng(38);
    const media::HenyeyGreensteinPhase phase(g);
    double largest = 0.0;
    for (int n = 3; n <= 7; ++n)
        for (int repeat = 0; repeat < 20; ++repeat) {
            const Points points = random_points(n, rng);
            const BruteForce brute(points, of_brute_force, with_sine);
            std::vector<double> weights, densities;
            const auto make = [&](int count, bool from_light) {
                return subpath(points, count, from_light, settings, phase, heuristic);
            };
            for (int s = 2; s + 2 <= n; ++s) {
                weights.push_back(weight_of_connection(points, make(s, true), make(n - s, false)));
                densities.push_back(brute.connection(s));
            }
            for (int k = 1; k + 1 < n; ++k)
                for (const Merge m : {Merge::point_point_3d, Merge::point_beam_2d, Merge::beam_beam_1d}) {
                    weights.push_back(weight_of_merge(make(k + 1, true), make(n - k, false), m, settings));
                    densities.push_back(brute.merge(k, m));
                }
            double total = 0.0;
            for (const double p : densities) total += mis_term(heuristic, p);
            for (std::size_t i = 0; i < weights.size(); ++i)
                largest =
                    std::max(largest, std::fabs(weights[i] - mis_term(heuristic, densities[i]) / total));
        }
    return largest;
}

BeamLength other(BeamLength length) {
    return length == BeamLength::short_beam ? BeamLength::long_beam : BeamLength::short_beam;
}

}  // namespace

TEST_CASE("weights of two subpaths in a medium are those of brute force", "[upbp][mis]") {
    for (const Heuristic heuristic : {Heuristic::balance, Heuristic::power})
        for (const BeamLength light : {BeamLength::short_beam, BeamLength::long_beam})
            for (const BeamLength eye : {BeamLength::short_beam, BeamLength::long_beam}) {
                MergeSettings settings;
                settings.radius = {0.0, 0.12, 0.07, 0.02}, settings.light_subpaths = {9.0, 8.0, 7.0, 6.0};
                settings.light_beams = light, settings.eye_beams = eye;
                CHECK(largest_difference(heuristic, settings, settings) < 1e-5);
                MergeSettings planted = settings;
                planted.light_beams = other(light);
                CHECK(largest_difference(heuristic, settings, planted) > 0.01);
                planted = settings, planted.eye_beams = other(eye);
                CHECK(largest_difference(heuristic, settings, planted) > 0.01);
                planted = settings, planted.light_subpaths[std::size_t(Merge::beam_beam_1d)] = 1.0;
                CHECK(largest_difference(heuristic, settings, planted) > 0.01);
                CHECK(largest_difference(heuristic, settings, settings, false) > 0.01);  // no sine
            }
}
