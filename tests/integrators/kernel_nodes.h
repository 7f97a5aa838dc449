// Light paths of a lamp in a medium, as nodes of a quadrature over the kernel of one technique of mote_upbp.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "core/scene/medium.h"
#include "integrators/upbp/light_beams.h"

namespace mote::tests {

using namespace core;
using namespace integrators;

/// The start of a light path, as the integrator has made it.
struct LampStart {
    PathVertex vertex;
    integrators::LightPoint point;
    Beam beam;  ///< in any direction
};

inline double squared(const Vec3d& d) { return glm::dot(d, d); }

/// exp(-optical depth) by midpoints.
inline Vec3d transmitted(const Medium& medium, const Vec3& from, const Vec3& to) {
    constexpr int steps = 4000;
    const Vec3d d = Vec3d(to) - Vec3d(from);
    Vec3d depth(0.0);
    for (int i = 0; i < steps; ++i)
        depth += Vec3d(medium.coefficients(Vec3(Vec3d(from) + (i + 0.5) / steps * d)).sigma_t);
    return glm::exp(-depth * (glm::length(d) / steps));
}

class KernelNodes {
  public:
    static constexpr double light_paths = 7.0;  ///< n of the pass; every node has n times its weight
    std::vector<Subpath> paths;
    std::vector<std::vector<LightBeam>> beams{1};

    KernelNodes(const Medium& medium, const LampStart& lamp, const MergeSettings& merging)
        : medium_(medium), lamp_(lamp), position_(lamp.point.position), merging_(merging) {}

    /// Photons in a ball of radius r.
    void fill_ball(const Vec3& centre, double r) {
        constexpr int n = 6;
        const double each = 4.0 / 3.0 * std::numbers::pi * r * r * r / (n * n * points_around);
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                const double s = r * std::cbrt((i + 0.5) / n), cosine = (2.0 * j + 1.0) / n - 1.0;
                add_ring(centre, s * std::sqrt(1.0 - cosine * cosine), s * cosine, each);
            }
    }
    /// Photons in a disc across z.
    void fill_disc(const Vec3& centre, double r) {
        constexpr int n = 6;
        const double each = std::numbers::pi * r * r / (n * points_around);
        for (int i = 0; i < n; ++i) add_ring(centre, r * std::sqrt((i + 0.5) / n), 0.0, each);
    }
    /// Beams that pass the line through `at` along z nearer than r, and nearest at `at`, by the angle phi
    /// around the axis through the lamp. Of all directions sin^3(theta) / (D cos(phi)) dphi dz do so in dz.
    void fill_fan(const Vec3& at, double r) {
        constexpr int count = 16;
        const Vec3d across(double(at.x) - position_.x, double(at.y) - position_.y, 0.0);
        const double distance = glm::length(across), widest = std::asin(r / distance);
        const Vec3d a = across / distance, b(-a.y, a.x, 0.0);
        for (int i = 0; i < count; ++i) {
            const double phi = widest * ((2.0 * i + 1.0) / count - 1.0), rho = distance * std::cos(phi);
            const Vec3d d =
                rho * (std::cos(phi) * a + std::sin(phi) * b) + Vec3d(0.0, 0.0, double(at.z) - position_.z);
            const double sine = rho / glm::length(d);
            add_beam(d, sine * sine * sine / rho * 2.0 * widest / count);
        }
    }

  private:
    static constexpr int points_around = 8;

    void add_ring(const Vec3& centre, double radius, double z, double measure) {
        for (int k = 0; k < points_around; ++k) {
            const double a = 2.0 * std::numbers::pi * (k + 0.5) / points_around;
            add_photon(Vec3(Vec3d(centre) + Vec3d(radius * std::cos(a), radius * std::sin(a), z)), measure);
        }
    }
    /// All that scatters in `measure`: a volume, or an area for each metre of z.
    void add_photon(const Vec3& at, double measure) {
        PathVertex v;
        const Vec3d d = Vec3d(position_) - Vec3d(at);
        v.scattering.position = at, v.scattering.phase = &medium_.phase();
        v.scattering.wo = Vec3(glm::normalize(d)), v.distance_squared = squared(d);
        Rng rng;
        TrackingCounters counters;
        const Ray ray{position_, -v.scattering.wo, 0.0f, float(glm::length(d))};
        v.weight = medium_.transmittance(ray, rng, counters) * medium_.coefficients(at).sigma_s *
                   float(light_paths * measure / v.distance_squared);
        set_merges(add_path(), medium_.coefficients(at), v);
        paths.back().vertices.push_back(v);
    }
    void add_beam(const Vec3d& d, double measure) {
        LightBeam light{std::uint32_t(paths.size()), lamp_.point, lamp_.beam};
        add_path();
        light.beam.ray.direction = Vec3(glm::normalize(d)), light.beam.reached = 1e3f;
        double reached = 1.0;  // a short beam comes to the node by chance
        if (merging_.light_beams == BeamLength::short_beam)
            reached = glm::dot(transmitted(medium_, position_, Vec3(Vec3d(position_) + d)), Vec3d(1.0 / 3.0));
        light.beam.weights.throughput = Rgb(float(light_paths * measure * reached));
        beams[0].push_back(light);
    }
    Subpath& add_path() {
        Subpath& path = paths.emplace_back();
        path.heuristic = Heuristic::balance, path.from_light = true, path.connects = false;
        path.merging = merging_, path.vertices = {lamp_.vertex};
        return path;
    }

    const Medium& medium_;
    const LampStart& lamp_;
    Vec3 position_;
    MergeSettings merging_;
};

}  // namespace mote::tests
