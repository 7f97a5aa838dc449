// Form factors between the shapes of a triangle list, counted from the links of bundles.
#pragma once

#include "gathering/ray_bundles/bundle_directions.h"
#include "tests/gathering/bundle_scenes.h"

namespace mote::tests {

/// A_i F_ij = 1/pi times the integral over directions of the area, across them, along which i sees j. Bundles
/// of directions uniform over the sphere serve both ways, with density 1/(2 pi) of each hemisphere: a link of
/// N directions represents 2 pi / N of solid angle and ray_area() of area.
class FormFactors {
  public:
    FormFactors(const gathering::SurfaceTriangles& triangles, std::uint32_t shapes)
        : triangles_(triangles), shapes_(shapes), sums_(shapes * shapes, 0.0), areas_(shapes, 0.0) {
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            const auto& c = triangles.corners[i];
            areas_[triangles.shape[i]] += 0.5 * double(glm::length(glm::cross(c[1] - c[0], c[2] - c[0])));
        }
    }

    void add(const gathering::RayBundle& bundle) {
        ++directions_;
        gathering::for_each_link(
            bundle, [&](std::size_t, const gathering::BundleHit& a, const gathering::BundleHit& b) {
                const std::uint32_t i = triangles_.shape[a.index()], j = triangles_.shape[b.index()];
                sums_[i * shapes_ + j] += double(bundle.grid.ray_area());
                sums_[j * shapes_ + i] += double(bundle.grid.ray_area());
            });
    }
    double factor(std::uint32_t from, std::uint32_t to) const {
        const double solid_angle = 2.0 * 3.14159265358979323846 / double(directions_);
        return sums_[from * shapes_ + to] * solid_angle / (3.14159265358979323846 * areas_[from]);
    }
    double area(std::uint32_t shape) const { return areas_[shape]; }

  private:
    const gathering::SurfaceTriangles& triangles_;
    std::uint32_t shapes_;
    std::vector<double> sums_, areas_;
    std::uint64_t directions_ = 0;
};

/// From directions [first, first + count) of a seed's sequence.
inline FormFactors form_factors(const gathering::BundleTracer& tracer, std::uint32_t shapes, float spacing,
                                std::uint64_t seed, std::uint32_t count) {
    FormFactors result(tracer.triangles(), shapes);
    for (std::uint32_t i = 0; i < count; ++i) {
        const gathering::BundleSample sample = gathering::bundle_sample(seed, i);
        result.add(tracer.trace(
            gathering::bundle_grid(sample.direction, tracer.triangles().bounds, spacing, sample.offset)));
    }
    return result;
}

/// Mean over seeds with its standard error.
struct SeedMean {
    double sum = 0.0, squares = 0.0;
    int count = 0;
    void add(double x) { sum += x, squares += x * x, ++count; }
    double mean() const { return sum / count; }
    double error() const { return std::sqrt((squares / count - mean() * mean()) / (count - 1)); }
    double z(double expected) const { return (mean() - expected) / error(); }
};

}  // namespace mote::tests
