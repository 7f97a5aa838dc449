// MIS weights over connections and merges against brute force: the joint density of every technique is
// multiplied up with every factor that the recursive weights leave out (sigma_t, both ends' densities,
// kernels).
#include <cmath>
#include <numbers>
#include <vector>

#include "core/math/random.h"
#include "integrators/bidirectional/merge_kernels.h"
#include "integrators/bidirectional/merged_weights.h"
#include "tests/support/catch.h"

using namespace mote::integrators;
using mote::core::Rng;

namespace {

enum class Planted { none, dimension, subpaths, sine, length, sigma_t, reverse };

struct PathOfNumbers {
    std::vector<double> from_light, from_eye;  ///< a, b [1/m^2], with tau, without sigma_t
    std::vector<double> tau;                   ///< of the edge between i - 1 and i
    std::vector<MergeVertex> vertices;
    std::vector<double> light_samples;  ///< of connection s: 0 where delta parts forbid it
    int size() const { return int(vertices.size()); }
};

double between(Rng& rng, double low, double high) {
    return low * std::pow(high / low, double(rng.next_float()));
}

PathOfNumbers random_path(int n, Rng& rng) {
    PathOfNumbers path;
    for (int i = 0; i < n; ++i) {
        path.from_light.push_back(between(rng, 0.01, 100.0));
        path.from_eye.push_back(between(rng, 0.01, 100.0));
        path.tau.push_back(between(rng, 0.01, 1.0));
        MergeVertex v;
        v.on_surface = rng.next_float() < 0.4f, v.connectable = rng.next_float() < 0.8f;
        v.sigma_t = v.on_surface ? 0.0 : between(rng, 0.1, 10.0), v.sine = double(rng.next_float());
        path.vertices.push_back(v);
    }
    path.vertices.front().connectable = path.vertices.back().connectable = true;
    for (int i = 1; i + 1 < n; ++i) {
        path.vertices[std::size_t(i)].tau_light = path.tau[std::size_t(i)];
        path.vertices[std::size_t(i)].tau_eye = path.tau[std::size_t(i) + 1];
    }
    for (int s = 0; s <= n; ++s) {
        const bool possible =
            s == 0 || s == n ||
            (path.vertices[std::size_t(s) - 1].connectable && path.vertices[std::size_t(s)].connectable);
        // The light path is joined to the lens by all light paths, a light is sampled by a density of its
        // own.
        const double c = s == n ? 0.0 : s == n - 1 ? 37.0 : s == 1 ? 0.3 : 1.0;
        path.light_samples.push_back(possible ? c : 0.0);
    }
    return path;
}

/// Joint densities of all techniques: connections s = 0 ... n, then merges at k by each technique.
class BruteForce {
  public:
    BruteForce(const PathOfNumbers& path, const MergeSettings& settings, Planted planted)
        : path_(path), settings_(settings), planted_(planted) {}

    double connection(int s) const {
        double p = path_.light_samples[std::size_t(s)];
        for (int i = 0; i < path_.size(); ++i) p *= i < s ? light(i) : eye(i);
        return p;
    }
    double merge(int k, Merge technique) const {
        const MergeVertex& v = path_.vertices[std::size_t(k)];
        double r = settings_.radius[std::size_t(technique)];
        if (v.on_surface != (technique == Merge::surface) || !v.connectable || r == 0.0) return 0.0;
        double p = planted_ == Planted::subpaths ? 1.0 : settings_.light_subpaths[std::size_t(technique)];
        for (int i = 0; i < path_.size(); ++i) {
            if (i < k) p *= light(i);
            if (i > k) p *= eye(i);
        }
        const bool point_light = technique != Merge::beam_beam_1d;
        const bool point_eye = technique == Merge::surface || technique == Merge::point_point_3d;
        p *= point_light ? light(k)
                         : beam(path_.from_light[std::size_t(k)], v.tau_light, settings_.light_beams);
        p *= point_eye ? eye(k) : beam(path_.from_eye[std::size_t(k)], v.tau_eye, settings_.eye_beams);
        return p * measure(technique, r, v);
    }

  private:
    double sigma(int i) const {
        const MergeVertex& v = path_.vertices[std::size_t(i)];
        return v.on_surface || planted_ == Planted::sigma_t ? 1.0 : v.sigma_t;
    }
    double light(int i) const { return path_.from_light[std::size_t(i)] * sigma(i); }
    double eye(int i) const {
        const double b = path_.from_eye[std::size_t(i)];
        return (planted_ == Planted::reverse && i == 1 ? 2.0 : 1.0) * b * sigma(i);
    }
    /// Density that a beam passes x_k: without that of the distance; a short one has to reach it.
    double beam(double density, double tau, BeamLength length) const {
        const bool is_long = (length == BeamLength::long_beam) != (planted_ == Planted::length);
        return density / tau * (is_long ? 1.0 : tau);
    }
    double measure(Merge technique, double r, const MergeVertex& v) const {
        constexpr double pi = std::numbers::pi;
        switch (technique) {
            case Merge::surface:
            case Merge::point_beam_2d:
                return pi * r * r;
            case Merge::point_point_3d:
                return planted_ == Planted::dimension ? pi * r * r : 4.0 / 3.0 * pi * r * r * r;
            case Merge::beam_beam_1d:
                return planted_ == Planted::sine ? 2.0 * r : 2.0 * r * v.sine;
        }
        return 0.0;
    }

    const PathOfNumbers& path_;
    const MergeSettings& settings_;
    Planted planted_;
};

/// Weights by recursion: A_k from the light, and from the camera.
struct Recursive {
    Recursive(const PathOfNumbers& numbers, const MergeSettings& of_merges, Heuristic h)
        : path(numbers), settings(of_merges), heuristic(h) {
        const int n = path.size();
        from_light.assign(std::size_t(n), 0.0), from_eye = from_light;
        for (int k = 0; k < n; ++k)
            from_light[std::size_t(k)] = techniques_before(
                heuristic, {path.from_light[std::size_t(k)], path.from_eye[std::size_t(k)], c(k), merges(k)},
                k > 0 ? from_light[std::size_t(k) - 1] : 0.0);
        for (int k = n - 1; k >= 0; --k)
            from_eye[std::size_t(k)] = techniques_before(
                heuristic,
                {path.from_eye[std::size_t(k)], path.from_light[std::size_t(k)], c(k + 1), merges(k)},
                k + 1 < n ? from_eye[std::size_t(k) + 1] : 0.0);
    }
    double c(int s) const { return mis_term(heuristic, path.light_samples[std::size_t(s)]); }
    double merges(int k) const {
        if (k == 0 || k + 1 == path.size()) return 0.0;
        return merge_terms(path.vertices[std::size_t(k)], settings, heuristic);
    }
    double connection(int s) const {
        return connection_weight(c(s), s > 0 ? from_light[std::size_t(s) - 1] : 0.0,
                                 s < path.size() ? from_eye[std::size_t(s)] : 0.0);
    }
    double merge(int k, Merge technique) const {
        const double kernel = merge_kernel(technique, path.vertices[std::size_t(k)], settings);
        const MergedVertex v{
            path.from_light[std::size_t(k)], path.from_eye[std::size_t(k)], c(k),     c(k + 1),
            from_light[std::size_t(k) - 1],  from_eye[std::size_t(k) + 1],  merges(k)};
        return kernel * merge_weight_over_kernel(heuristic, v, kernel);
    }
    const PathOfNumbers& path;
    const MergeSettings& settings;
    Heuristic heuristic;
    std::vector<double> from_light, from_eye;
};

/// Largest difference between recursive weights and brute force; also adds up the recursive ones.
double difference(const PathOfNumbers& path, const MergeSettings& settings, Heuristic heuristic,
                  Planted planted, double* sum) {
    const BruteForce brute(path, settings, planted);
    const Recursive recursive(path, settings, heuristic);
    std::vector<double> densities, weights;
    for (int s = 0; s < path.size(); ++s)
        densities.push_back(brute.connection(s)), weights.push_back(recursive.connection(s));
    for (int k = 1; k + 1 < path.size(); ++k)
        for (std::size_t m = 0; m < merge_count; ++m)
            densities.push_back(brute.merge(k, Merge(m))), weights.push_back(recursive.merge(k, Merge(m)));
    double total = 0.0, largest = 0.0;
    for (double p : densities) total += mis_term(heuristic, p);
    *sum = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        largest = std::max(largest, std::fabs(weights[i] - mis_term(heuristic, densities[i]) / total));
        *sum += weights[i];
    }
    return largest;
}

MergeSettings settings_of(int which, Rng& rng) {
    MergeSettings settings;
    for (std::size_t m = 0; m < merge_count; ++m)
        settings.radius[m] = which >> m & 1 ? between(rng, 0.05, 0.5) : 0.0;
    settings.light_subpaths = {50.0, 40.0, 30.0, 20.0};
    settings.light_beams = which & 16 ? BeamLength::long_beam : BeamLength::short_beam;
    settings.eye_beams = which & 32 ? BeamLength::long_beam : BeamLength::short_beam;
    return settings;
}

/// Largest difference over paths of up to six edges, all sets of techniques and both lengths of beams.
double largest_difference(Heuristic heuristic, Planted planted) {
    Rng rng(38);
    double largest = 0.0;
    for (int n = 2; n <= 7; ++n)
        for (int which = 0; which < 64; ++which)
            for (int i = 0; i < 20; ++i) {
                const MergeSettings settings = settings_of(which, rng);
                double sum = 0.0;
                largest =
                    std::max(largest, difference(random_path(n, rng), settings, heuristic, planted, &sum));
                CHECK(std::fabs(sum - 1.0) < 1e-9);  // rounding alone
            }
    return largest;
}

}  // namespace

TEST_CASE("weights over connections and merges are those of brute force and add up to one", "[upbp][mis]") {
    for (const Heuristic heuristic : {Heuristic::balance, Heuristic::power}) {
        CHECK(largest_difference(heuristic, Planted::none) < 1e-9);  // rounding alone
        for (const Planted planted : {Planted::dimension, Planted::subpaths, Planted::sine, Planted::length,
                                      Planted::sigma_t, Planted::reverse}) {
            INFO(int(planted));
            CHECK(largest_difference(heuristic, planted) > 0.01);
        }
    }
}

TEST_CASE("merges stay finite at extremes", "[upbp][mis][extremes]") {
    MergeSettings settings;
    settings.light_subpaths = {1e8, 1e8, 1e8, 1e8}, settings.radius = {0.1, 0.1, 0.1, 0.1};
    settings.light_beams = settings.eye_beams = BeamLength::long_beam;
    MergeVertex v;
    v.sigma_t = 1.0;
    SECTION("parallel beams: no density, a finite weight over it") {
        v.sine = 0.0;
        const double kernel = merge_kernel(Merge::beam_beam_1d, v, settings);
        CHECK(kernel == 0.0);
        MergedVertex merged;
        merged.merges = merge_terms(v, settings, Heuristic::balance);
        const double over = merge_weight_over_kernel(Heuristic::balance, merged, kernel);
        CHECK(over > 0.0);
        CHECK(std::isfinite(over));
        CHECK(merge_weight_over_kernel(Heuristic::power, merged, kernel) == 0.0);
    }
    SECTION("no radius, no medium, no light subpath: no technique") {
        MergeSettings none = settings;
        none.radius = {};
        CHECK(merge_terms(v, none, Heuristic::balance) == 0.0);
        none = settings, none.light_subpaths = {};
        CHECK(merge_terms(v, none, Heuristic::balance) == 0.0);
        v.sigma_t = 0.0;
        CHECK(merge_terms(v, settings, Heuristic::balance) == 0.0);
    }
    SECTION("optical depths of 1e-6 and 1e4, radii larger than any scene: finite sums") {
        for (const double sigma_t : {1e-6, 1e4})
            for (const double radius : {1e-9, 1e9}) {
                v.sigma_t = sigma_t, v.tau_light = v.tau_eye = sigma_t > 1.0 ? std::exp(-40.0) : 1.0;
                settings.radius = {radius, radius, radius, radius};
                for (const Heuristic heuristic : {Heuristic::balance, Heuristic::power}) {
                    const double sum = techniques_before(
                        heuristic, {1.0, 1.0, 1.0, merge_terms(v, settings, heuristic)}, 1.0);
                    CHECK(std::isfinite(sum));
                    CHECK(connection_weight(1.0, sum, sum) >= 0.0);
                    CHECK(connection_weight(1.0, sum, sum) <= 1.0);
                }
            }
    }
}
