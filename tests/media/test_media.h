// Media and references that several media tests share.
#pragma once

#include <functional>
#include <memory>

#include "media/constant_volume.h"
#include "media/grid_volume.h"
#include "media/heterogeneous_medium.h"
#include "media/phase_functions.h"
#include "media/vol_file.h"
#include "tests/media/spectral_estimates.h"

namespace mote::tests {

inline media::MediumParts medium_parts(const core::Rgb& albedo, float scale = 1.0f) {
    media::MediumParts parts;
    parts.albedo = std::make_shared<media::ConstantVolume>(albedo);
    parts.phase = std::make_shared<media::IsotropicPhase>();
    parts.scale = scale;
    return parts;
}

/// A .vol grid whose voxel (x, y, z) holds value(x, y, z).
inline media::VolFile vol_grid(const glm::ivec3& n, int channels,
                               const std::function<core::Rgb(int, int, int)>& value) {
    media::VolFile file;
    file.resolution = n, file.channels = channels;
    file.bounds = {core::Vec3(0.0f), core::Vec3(1.0f)};
    for (int z = 0; z < n.z; ++z)
        for (int y = 0; y < n.y; ++y)
            for (int x = 0; x < n.x; ++x)
                for (int c = 0; c < channels; ++c) file.values.push_back(value(x, y, z)[c]);
    return file;
}

/// Random densities, half of the voxels empty: thin and dense parts side by side.
inline media::VolFile random_grid(const glm::ivec3& n, int channels, std::uint64_t seed) {
    return vol_grid(n, channels, [rng = core::Rng(seed)](int, int, int) mutable {
        const float on = rng.next_float() < 0.5f ? 0.0f : 4.0f;
        return on * core::Rgb(rng.next_float(), rng.next_float(), rng.next_float());
    });
}

/// 16^3 voxels of 0.1 with three voxels of `hot` in a row along x, each in a channel of its own where there
/// are three.
inline media::VolFile hot_grid(int channels, float hot) {
    return vol_grid(glm::ivec3(16), channels, [=](int x, int y, int z) {
        core::Rgb value(0.1f);
        if (x % 4 == 3 && x < 15 && y == 8 && z == 8) value[channels == 1 ? 0 : x / 4] = hot;
        return value;
    });
}
/// Past these voxels, at 0.97 of the distance at which they end in y and in z: 9e-4 of each is met.
inline const core::Ray past_hot{core::Vec3(0.01f, 9.47f / 16.0f, 9.47f / 16.0f), core::Vec3(1, 0, 0), 0.0f,
                                0.98f};

inline std::shared_ptr<media::HeterogeneousMedium> medium_of(media::VolFile file, media::MediumParts parts,
                                                             const core::Transform& to_world = {}) {
    return media::GridVolume(std::move(file), to_world, false, "test").make_medium(std::move(parts));
}

/// Optical depth from t_min to t, by the midpoint rule on Medium::coefficients(): free of tracking.
inline core::Vec3d quadrature_depth(const core::Medium& medium, const core::Ray& ray, double t, int steps) {
    core::Vec3d sum(0.0);
    const double h = (t - ray.t_min) / steps;
    for (int i = 0; i < steps; ++i)
        sum += core::Vec3d(medium.coefficients(ray.at(float(ray.t_min + (i + 0.5) * h))).sigma_t) * h;
    return sum;
}

/// Every estimator of `e` against the optical depth `tau`, for albedo `a`: the largest deviation in standard
/// errors. `floor` is the relative error of the reference and of single precision.
inline double worst_sigmas(const SpectralEstimates& e, const core::Vec3d& tau, const core::Rgb& a,
                           double floor = 1e-5) {
    double worst = 0.0;
    for (int c = 0; c < 3; ++c) {
        const double t = std::exp(-tau[c]);
        const std::size_t i = std::size_t(c);
        worst = std::max({worst, e.escape[i].sigmas_from(t, floor), e.connection[i].sigmas_from(t, floor),
                          e.two_techniques[i].sigmas_from(t, floor), e.transmittance[i].sigmas_from(t, floor),
                          e.collision[i].sigmas_from(a[c] * (1.0 - t), floor)});
    }
    return worst;
}

}  // namespace mote::tests
