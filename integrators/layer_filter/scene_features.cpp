#include "integrators/layer_filter/scene_features.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/render/camera_ray.h"
#include "core/render/first_hit_features.h"
#include "core/render/pass_runner.h"
#include "core/scene/media_along.h"
#include "integrators/layer_filter/eye_march.h"

namespace mote::integrators {

using namespace core;
using screenspace::FeatureSample;
using screenspace::FilterFeatures;
using screenspace::FineFeatures;
using screenspace::PixelFrame;

namespace {

constexpr std::uint64_t feature_stream = 0x66696c746572ull;  // apart from the rays of the picture

/// Eye rays of a pixel, or of a quarter of one, and the surfaces and media that they see.
class FeatureRays {
  public:
    /// `options`: with the seed of the features; `per_pixel`: 1, or 2 for quarters, whose image is twice as
    /// large as the film.
    FeatureRays(const Scene& scene, const RenderOptions& options, const FeatureSettings& settings,
                const PassContext& pass, int per_pixel = 1)
        : scene_(scene),
          options_(options),
          settings_(settings),
          pass_(pass),
          per_pixel_(per_pixel),
          samples_(std::size_t(settings.samples)),
          rays_(std::size_t(settings.samples)) {}

    /// Valid until the next call.
    std::span<const FeatureSample> find(int x, int y) {
        float last = 0.0f, end = 0.0f;
        for (int k = 0; k < settings_.samples; ++k) {
            const Ray ray = eye_ray(std::uint32_t(k), x, y);
            Rng rng(hash_keys(options_.seed, k, pixel_key(options_, x, y)));
            FeatureSample& s = samples_[std::size_t(k)];
            s = look(ray, rng);
            rays_[std::size_t(k)] = ray;
            if (s.hit) last = std::fmax(last, s.distance);
            end = std::fmax(end, s.hit ? s.distance : ray.t_max);
        }
        if (scene_.has_media()) march(last, end);
        return samples_;
    }

  private:
    Ray eye_ray(std::uint32_t k, int x, int y) const {
        const PassContext pass{k, pass_.filter, pass_.cancelled};
        if (per_pixel_ == 1) return camera_ray(scene_.camera(), options_, pass, x, y);
        Sampler sampler = pixel_sampler(options_, pass, x, y);
        const Vec2 film = (Vec2(float(x), float(y)) + sampler.next_2d()) / float(per_pixel_);
        return scene_.camera().sample_ray(film, sampler.next_2d());
    }

    FeatureSample look(const Ray& ray, Rng& rng) const {
        FeatureSample s;
        const FirstStop stop = first_stop(scene_, ray, rng);
        if (!stop.hit) return s;
        const FirstHit first{scene_, ray, *stop.hit, stop.chance, rng};
        const BsdfTraits traits = stop.hit->shape->bsdf->traits();
        s.hit = true, s.filterable = !traits.delta || is_pane(*stop.hit);
        s.distance = stop.hit->t, s.position = stop.hit->position;
        s.normal = first.facing(stop.hit->geometric_normal);
        s.shading_normal = first.facing(stop.hit->shading.n);
        s.reflected = s.filterable ? first_hit_albedo(first) * glass_before(ray, stop.hit->t) : Rgb(0.0f);
        return s;
    }

    /// Transmittance of thin glass, which all paths pass alike; masks they pass by chance.
    Rgb glass_before(Ray ray, float t) const {
        Rgb product(1.0f);
        if (!scene_.has_panes()) return product;
        ray.t_max = t;
        scene_.for_each_boundary(ray, [&](const SurfaceHit& hit) {
            if (is_pane(hit) && !hit.shape->bsdf->traits().smooth)
                product *= passage_through(hit, ray.direction).transmittance();
            return true;
        });
        return product;
    }

    void march(float last, float end) {
        Ray ray = rays_[0];
        ray.t_max = end;
        march_.march(scene_, ray, last, settings_.voxels, walk_);
        for (std::size_t k = 0; k < samples_.size(); ++k) {
            FeatureSample& s = samples_[k];
            const EyeMarch::Value value = march_.at(s.hit ? s.distance : rays_[k].t_max);
            s.transmittance = average(value.transmittance);
            s.reflected *= value.transmittance, s.scattering = value.scattering;
        }
    }

    const Scene& scene_;
    const RenderOptions& options_;
    const FeatureSettings& settings_;
    const PassContext& pass_;
    int per_pixel_;
    std::vector<FeatureSample> samples_;
    std::vector<Ray> rays_;
    EyeMarch march_;
    WalkContext walk_;
};

/// A row of pixels, worked on by one thread.
class FeatureRow {
  public:
    FeatureRow(const Scene& scene, const RenderOptions& options, const FeatureSettings& settings,
               const PassContext& pass)
        : scene_(scene), options_(options), rays_(scene, options, settings, pass) {}

    void fill(int y, FilterFeatures& features) {
        for (int x = 0; x < options_.width; ++x) {
            const auto samples = rays_.find(x, y);
            const std::size_t pixel = std::size_t(y) * std::size_t(options_.width) + std::size_t(x);
            if (!features.set_pixel(pixel, samples, frame(samples, x, y))) continue;
            mixed.push_back(std::uint32_t(pixel));
            mixed_samples.insert(mixed_samples.end(), samples.begin(), samples.end());
        }
    }

    std::vector<std::uint32_t> mixed;
    std::vector<FeatureSample> mixed_samples;

  private:
    /// From the rays through the pixel's middle and one pixel to the right and down, on the tangent plane.
    PixelFrame frame(std::span<const FeatureSample> samples, int x, int y) const {
        const auto mean = screenspace::mean_surface(samples);
        PixelFrame result;
        if (!mean.hit) return result;
        const Vec2 film(float(x) + 0.5f, float(y) + 0.5f);
        const auto at = [&](const Vec2& place) { return scene_.camera().sample_ray(place, Vec2(0.5f)); };
        const Ray here = at(film), right = at(film + Vec2(1, 0)), down = at(film + Vec2(0, 1));
        const float d = mean.distance;
        result.footprint =
            std::fmax(glm::length(right.at(d) - here.at(d)), glm::length(down.at(d) - here.at(d)));
        // Where the surface is seen at less than a degree, its plane has no pixels to speak of.
        const bool grazing = std::fabs(glm::dot(here.direction, mean.normal)) < 0.02f;
        const Vec3 n = grazing ? -here.direction : mean.normal;
        const auto meet = [&](const Ray& ray) {
            const float cosine = glm::dot(ray.direction, n);
            const float t = std::fabs(cosine) > 1e-6f ? glm::dot(mean.position - ray.origin, n) / cosine : d;
            return ray.at(t);
        };
        // In footprints: the fourth power of a pixel in a scene of nanometres is no number.
        const float unit = result.footprint;
        const Vec3 a = (meet(right) - meet(here)) / unit, b = (meet(down) - meet(here)) / unit,
                   area = glm::cross(a, b);
        const float squared = glm::dot(area, area) * unit;
        if (!(squared > 0.0f) || !is_finite(squared)) return result;
        result.along_x = glm::cross(b, area) / squared, result.along_y = glm::cross(area, a) / squared;
        return result;
    }

    const Scene& scene_;
    const RenderOptions& options_;
    FeatureRays rays_;
};

RenderOptions feature_options(const RenderOptions& options) {
    RenderOptions own = options;
    own.seed = hash_keys(options.seed, feature_stream);
    return own;
}

void set_quarter(FineFeatures& features, std::size_t quarter, std::span<const FeatureSample> samples) {
    Rgb reflected(0.0f);
    Vec3 normal(0.0f);
    for (const FeatureSample& s : samples) reflected += s.reflected, normal += s.shading_normal;
    features.reflected[quarter] = reflected / float(samples.size());
    features.normal[quarter] = screenspace::unit_or_zero(normal);
}

}  // namespace

FilterFeatures find_filter_features(const Scene& scene, const RenderOptions& options,
                                    const FeatureSettings& settings) {
    FilterFeatures features(options.width, options.height, settings.samples);
    const auto filter = film_filter(scene);
    const std::atomic<bool> never{false};
    const PassContext pass{0, *filter, never};
    const RenderOptions own = feature_options(options);
    std::vector<FeatureRow> rows(std::size_t(options.height), FeatureRow(scene, own, settings, pass));
    tbb::parallel_for(0, options.height, [&](int y) {
        if (!options.cancelled.requested()) rows[std::size_t(y)].fill(y, features);
    });
    options.cancelled.check();
    for (const FeatureRow& row : rows) {
        features.mixed.insert(features.mixed.end(), row.mixed.begin(), row.mixed.end());
        features.samples.insert(features.samples.end(), row.mixed_samples.begin(), row.mixed_samples.end());
    }
    return features;
}

FineFeatures find_fine_features(const Scene& scene, const RenderOptions& options,
                                const FeatureSettings& settings) {
    RenderOptions own = feature_options(options);
    own.width *= 2, own.height *= 2;
    const std::size_t quarters = std::size_t(own.width) * std::size_t(own.height);
    FineFeatures features{own.width, own.height, std::vector<Rgb>(quarters), std::vector<Vec3>(quarters),
                          scene.camera().traits().delta_position};
    const FeatureSettings of_quarter{std::max(1, settings.samples / 4), 2.0f * settings.voxels};
    const auto filter = film_filter(scene);
    const std::atomic<bool> never{false};
    const PassContext pass{0, *filter, never};
    tbb::parallel_for(0, own.height, [&](int y) {
        if (options.cancelled.requested()) return;
        FeatureRays rays(scene, own, of_quarter, pass, 2);
        for (int x = 0; x < own.width; ++x)
            set_quarter(features, std::size_t(y) * std::size_t(own.width) + std::size_t(x), rays.find(x, y));
    });
    options.cancelled.check();
    return features;
}

}  // namespace mote::integrators
