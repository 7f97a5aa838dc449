// Scenes for the exchange of radiance, held together with their atlas and bundles.
#pragma once

#include <fmt/format.h>

#include "gathering/radiance_exchange/radiance_exchange.h"
#include "tests/support/render_statistics.h"

namespace mote::tests {

/// All that an exchange needs, from the text of a scene.
struct ExchangeStage {
    std::unique_ptr<core::Scene> scene;
    gathering::SurfaceTriangles surfaces;
    gathering::SurfaceAtlas atlas;
    gathering::TexelMaterials materials;
    gathering::BundleTracer tracer;

    explicit ExchangeStage(const std::string& xml, const gathering::AtlasSettings& settings)
        : scene(scene_from(xml)),
          surfaces(gathering::surface_triangles(scene->shapes())),
          atlas(surfaces, scene->shapes(), settings),
          materials(gathering::texel_materials(atlas)),
          tracer(surfaces) {}

    gathering::ExchangeScene view() const { return {atlas, materials, tracer, scene->environment()}; }
    gathering::ArrivingLight solve(const gathering::ExchangeSettings& settings, std::uint64_t key,
                                   const gathering::TexelDirectLight& direct = {}) const {
        gathering::ExchangeStatistics statistics;
        return exchange_light(view(), settings, direct, key, {}, statistics);
    }
    /// Mean of an irradiance over all surfaces, first channel.
    double mean(const std::vector<core::Rgb>& irradiance) const {
        double sum = 0.0, area = 0.0;
        for (std::size_t t = 0; t < atlas.size(); ++t)
            sum += double(irradiance[t].x) * double(atlas.texels()[t].area),
                area += double(atlas.texels()[t].area);
        return sum / area;
    }
};

/// A room without an opening whose walls emit `emission` and reflect `reflectance`.
inline std::string furnace(double reflectance, double emission, const std::string& shape = "cube") {
    return fmt::format(R"(<scene version="3.0.0"><shape type="{}"><boolean name="flip_normals" value="true"/>
        <bsdf type="diffuse"><rgb name="reflectance" value="{}"/></bsdf>
        <emitter type="area"><rgb name="radiance" value="{}"/></emitter></shape>
        <sensor type="perspective"/></scene>)",
                       shape, reflectance, emission);
}

/// Mean and standard error of independent numbers.
struct Trials {
    double sum = 0.0, squares = 0.0;
    int count = 0;
    void add(double x) { sum += x, squares += x * x, ++count; }
    double mean() const { return sum / count; }
    double error() const { return std::sqrt(std::max(0.0, squares / count - mean() * mean()) / (count - 1)); }
    /// How far from `expected`, in standard errors.
    double z(double expected) const { return std::fabs(mean() - expected) / error(); }
    /// Value that
    /// z
    ///  exceeds with a probability of 7e-6 (a hundred comparisons share it): Student's quantile, from the
    ///    normal one by Fisher's expansion in one over the degrees of freedom.
    double critical() const {
        const double z1 = 4.5, z3 = z1 * z1 * z1, z5 = z3 * z1 * z1, z7 = z5 * z1 * z1, n = count - 1;
        return z1 + (z3 + z1) / (4 * n) + (5 * z5 + 16 * z3 + 3 * z1) / (96 * n * n) +
               (3 * z7 + 19 * z5 + 17 * z3 - 15 * z1) / (384 * n * n * n);
    }
    bool is(double expected) const { return z(expected) < critical(); }
};

}  // namespace mote::tests
