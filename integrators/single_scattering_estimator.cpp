#include "integrators/single_scattering_estimator.h"

#include <algorithm>

#include "integrators/counters.h"
#include "screenspace/epipolar_picture.h"
#include "screenspace/in_scattering_grid.h"
#include "screenspace/in_scattering_rays.h"
#include "screenspace/shared_eye_rays.h"

namespace mote::integrators {

using namespace core;
using namespace screenspace;

namespace {

constexpr int tile_size = 16;

/// The numbers that all pixels of a pass share.
struct PassNumbers {
    Vec2 lens, lines, march, grid;
    PassNumbers(const RenderOptions& options, std::uint32_t pass) {
        Sampler sampler(options.sampler, options.seed, pass, ~std::uint64_t(0), 0x65706970u);
        lens = sampler.next_2d(), lines = sampler.next_2d(), march = sampler.next_2d(),
        grid = sampler.next_2d();
    }
};

/// What interpolation needs to know of a pixel's first ray: 24 bytes.
struct EyePoint {
    Vec2 film;
    FirstSurface surface;
};

struct ScatteringCounts {
    std::uint64_t rays = 0, steps = 0, filled = 0, lines = 0, texels = 0, candidates = 0, shared = 0,
                  clear = 0;
    std::size_t bytes = 0;
};

template <bool Media>
class SingleScatteringEstimator final : public Estimator {
  public:
    SingleScatteringEstimator(const Scene& scene, const RenderOptions& options,
                              const ScatteringSettings& settings)
        : scene_(scene), options_(options), settings_(settings) {
        if (!Media) return;
        aids_.emplace(scene, settings.aids);
        settings_.eye.maps = aids_->maps();
        settings_.eye.voxels = settings.march.voxels;
        settings_.eye.other_lights = false;
        for (const auto& light : scene.emitters())
            settings_.eye.other_lights |= !light->traits().delta_position;
        for (const auto& medium : scene.media()) settings_.eye.other_lights |= medium->traits().emissive;
    }

    bool pass(const PassContext& context, PassImage& image) override;
    void add_statistics(Statistics& statistics) const override;

  private:
    Ray eye_ray(const Vec2& film, const PassNumbers& numbers) const {
        return scene_.camera().sample_ray(film, numbers.lens);
    }
    void render_eye(const PassContext& context, const PassNumbers& numbers,
                    std::span<const InScattering> lights, PassImage& image, int x, int y,
                    MarchScratch& scratch);
    using Lines = std::unique_ptr<EpipolarPicture>;
    Lines find_lines(const PassNumbers& numbers, const InScattering& light, const InScatteringRays& source,
                     const EpipolarPicture::Loop& loop) const;
    std::vector<Lines> share_rays(const PassContext& context, const PassNumbers& numbers,
                                  std::span<const InScattering> lights);
    bool scatter(const PassContext& context, const PassNumbers& numbers, const InScattering& light,
                 Lines lines, PassImage& image);
    static EpipolarPicture::Loop loop_of(const PassContext& context) {
        return [&context](int count, const std::function<void(int)>& body) {
            for_each_tile(count, 1, 1, context.cancelled, [&](int i, int, int, int) { body(i); });
        };
    }
    void show(const std::vector<Vec2d>& places, PassImage& image) const;
    template <typename LightAt>
    bool upsample(const PassContext& context, const PassNumbers& numbers, const InScattering& light,
                  const InScatteringRays& source, PassImage& image, const LightAt& light_at);
    FilmRectangle frame() const;

    const Scene& scene_;
    RenderOptions options_;
    ScatteringSettings settings_;
    std::optional<ScatteringAids> aids_;  ///< nothing without media
    SharedCounters counters_;
    std::mutex mutex_;
    ScatteringCounts counts_;
    std::vector<EyePoint> points_;
};

/// The film, and as much around it as pixel filters reach.
template <bool Media>
FilmRectangle SingleScatteringEstimator<Media>::frame() const {
    const double margin = std::max(0.5, double(scene_.film().filter_radius));
    return {Vec2d(-margin), Vec2d(options_.width + margin, options_.height + margin)};
}

template <bool Media>
void SingleScatteringEstimator<Media>::render_eye(const PassContext& context, const PassNumbers& numbers,
                                                  std::span<const InScattering> lights, PassImage& image,
                                                  int x, int y, MarchScratch& scratch) {
    const std::uint64_t pixel = std::uint64_t(y) * std::uint64_t(options_.width) + std::uint64_t(x);
    Sampler sampler(options_.sampler, options_.seed, context.index, pixel);
    scratch.walk.rng = sampler.make_rng();
    const Vec2 film =
        Vec2(float(x) + 0.5f, float(y) + 0.5f) + context.filter.sample_offset(sampler.next_2d());
    const Ray ray = eye_ray(film, numbers);
    const MediumState state = Media ? scene_.camera_medium_state() : MediumState();
    EyePath path = trace_eye<Media>(scene_, settings_.eye, lights, ray, state, sampler, scratch);
    if constexpr (Media) {
        const FirstSurface first =
            path.first ? FirstSurface{path.first->t, path.first->geometric_normal} : FirstSurface{};
        if (!points_.empty()) points_[std::size_t(pixel)] = {film, first};
        for (const InScattering& light : lights) {
            if (settings_.sampling != ScatteringSampling::full) break;
            Ray lit = ray;
            const RayEnd end = lit_end(light, ray, first);
            if (end.dark()) continue;
            lit.t_max = end.distance;
            path.sum[Transport::single_scattering] += light.march(lit, state, scratch).radiance;
            if (settings_.show_samples) image.at(3, x, y) += Rgb(1.0f);
        }
        image.at(2, x, y) = path.sum[Transport::single_scattering];
    }
    image.at(0, x, y) = path.sum[Transport::emission], image.at(1, x, y) = path.sum[Transport::direct];
}

/// Counts marched rays. What lies outside the film belongs to its border.
template <bool Media>
void SingleScatteringEstimator<Media>::show(const std::vector<Vec2d>& places, PassImage& image) const {
    for (const Vec2d& p : places)
        image.at(3, std::clamp(int(std::floor(p.x)), 0, options_.width - 1),
                 std::clamp(int(std::floor(p.y)), 0, options_.height - 1)) += Rgb(1.0f);
}

/// Adds light_at(film, end, task) to every pixel; where it returns nothing, the pixel's ray is marched.
template <bool Media>
template <typename LightAt>
bool SingleScatteringEstimator<Media>::upsample(const PassContext& context, const PassNumbers& numbers,
                                                const InScattering& light, const InScatteringRays& source,
                                                PassImage& image, const LightAt& light_at) {
    return for_each_tile(
        options_.width, options_.height, tile_size, context.cancelled, [&](int x0, int y0, int x1, int y1) {
            const auto task = source.start();
            std::uint64_t filled = 0, candidates = 0;
            for (int y = y0; y < y1; ++y)
                for (int x = x0; x < x1; ++x) {
                    const EyePoint& point =
                        points_[std::size_t(y) * std::size_t(options_.width) + std::size_t(x)];
                    const RayEnd end = lit_end(light, eye_ray(point.film, numbers), point.surface);
                    if (end.dark()) continue;
                    ++candidates;
                    auto scattered = light_at(Vec2d(point.film), end, *task);
                    if (!scattered) {
                        scattered = task->march(Vec2d(point.film), end).radiance, ++filled;
                        if (settings_.show_samples) image.at(3, x, y) += Rgb(1.0f);
                    }
                    image.at(2, x, y) += *scattered;
                }
            const std::lock_guard lock(mutex_);
            counts_.filled += filled, counts_.candidates += candidates;
        });
}

/// The light's lines, searched for edges; null for a light at the eye.
template <bool Media>
auto SingleScatteringEstimator<Media>::find_lines(const PassNumbers& numbers, const InScattering& light,
                                                  const InScatteringRays& source,
                                                  const EpipolarPicture::Loop& loop) const -> Lines {
    // Closer to the eye than this, single precision leaves no direction to tell lines apart.
    const double nearest = 1e-5 * std::max(1e-30, double(scene_.bounds().radius()));
    const FilmPoint at = FilmProjection(scene_.camera(), options_.width, options_.height, numbers.lens)
                             .project(Vec3d(light.light_position()), nearest);
    if (at.x == 0.0 && at.y == 0.0 && at.w == 0.0) return nullptr;
    LineSampling sampling = settings_.line;
    sampling.shift = double(numbers.lines.y);
    return std::make_unique<EpipolarPicture>(
        EpipolarLines(at, frame(), settings_.lines, double(numbers.lines.x)), sampling, source, loop);
}

/// The lines of all lights, with what was marched for two of them at once.
template <bool Media>
auto SingleScatteringEstimator<Media>::share_rays(const PassContext& context, const PassNumbers& numbers,
                                                  std::span<const InScattering> lights)
    -> std::vector<Lines> {
    std::vector<Lines> all;
    std::vector<EpipolarPicture*> pictures;
    std::vector<const InScattering*> with_lines;
    for (const InScattering& light : lights) {
        const InScatteringRays source(scene_, light, numbers.lens);
        all.push_back(find_lines(numbers, light, source, loop_of(context)));
        counters_.add(source.rays(), source.tracking());
        if (all.back()) pictures.push_back(all.back().get()), with_lines.push_back(&light);
    }
    const SharedEyeRays rays(scene_, with_lines, settings_.march.voxels, numbers.lens);
    const std::size_t shared = march_crossings(pictures, rays, loop_of(context));
    std::size_t bytes = shared * crossing_bytes + points_.capacity() * sizeof(EyePoint);
    for (const EpipolarPicture* picture : pictures) bytes += picture->counts().bytes;
    counts_.shared += shared, counts_.bytes = std::max(counts_.bytes, bytes);
    counts_.rays += rays.done().rays, counts_.steps += rays.done().steps;
    counts_.clear += rays.done().clear;
    counters_.add(rays.done().walk.rays, rays.done().walk.tracking);
    return all;
}

template <bool Media>
bool SingleScatteringEstimator<Media>::scatter(const PassContext& context, const PassNumbers& numbers,
                                               const InScattering& light, Lines lines, PassImage& image) {
    const InScatteringRays source(scene_, light, numbers.lens);
    const auto loop = loop_of(context);
    const bool epipolar = settings_.sampling == ScatteringSampling::epipolar;
    if (epipolar && !lines) lines = find_lines(numbers, light, source, loop);
    bool done;
    std::size_t bytes;
    if (lines) {
        lines->march(source, loop);
        if (context.cancelled) return false;
        done = upsample(context, numbers, light, source, image,
                        [&](const Vec2d& film, const RayEnd& end, InScatteringTask& task) {
                            return lines->light_at(film, end, task);
                        });
        if (settings_.show_samples) show(lines->marched_at(), image);
        const PictureCounts counts = lines->counts();
        counts_.lines += counts.lines, counts_.texels += counts.texels, bytes = counts.bytes;
    } else {
        double spacing = settings_.spacing;
        if (epipolar)  // as many rays as the lines would have
            spacing = std::max(1.0, std::sqrt(double(options_.width) * double(options_.height) /
                                              (double(settings_.lines) * settings_.line.initial)));
        const InScatteringGrid grid(frame(), spacing, Vec2d(numbers.grid), settings_.line.depth_tolerance,
                                    source, loop);
        done = upsample(context, numbers, light, source, image,
                        [&](const Vec2d& film, const RayEnd& end, InScatteringTask&) {
                            return grid.light_at(film, end);
                        });
        if (settings_.show_samples) show(grid.marched_at(), image);
        bytes = grid.memory_bytes();
    }
    counts_.bytes = std::max(counts_.bytes, bytes + points_.capacity() * sizeof(EyePoint));
    counts_.rays += source.marched(), counts_.steps += source.steps();
    counts_.clear += source.clear();
    counters_.add(source.rays(), source.tracking());
    return done;
}

template <bool Media>
bool SingleScatteringEstimator<Media>::pass(const PassContext& context, PassImage& image) {
    const PassNumbers numbers(options_, context.index);
    MarchSettings march = settings_.march;
    march.offset = numbers.march.x;
    std::vector<InScattering> lights;
    if constexpr (Media)
        for (const Emitter* light : positional_lights(scene_))
            lights.emplace_back(scene_, *light, march, aids_->of(*light));
    const bool full = settings_.sampling == ScatteringSampling::full;
    if (!full && !lights.empty()) points_.resize(std::size_t(options_.width) * std::size_t(options_.height));

    const bool eyes = for_each_tile(options_.width, options_.height, tile_size, context.cancelled,
                                    [&](int x0, int y0, int x1, int y1) {
                                        MarchScratch scratch;
                                        for (int y = y0; y < y1; ++y)
                                            for (int x = x0; x < x1; ++x)
                                                render_eye(context, numbers, lights, image, x, y, scratch);
                                        counters_.add(scratch.walk.rays, scratch.walk.tracking);
                                        const std::lock_guard lock(mutex_);
                                        counts_.rays += scratch.rays, counts_.steps += scratch.steps;
                                        counts_.clear += scratch.clear;
                                        if (full) counts_.candidates += scratch.rays;
                                    });
    if (!eyes) return false;
    if (full) return true;
    std::vector<Lines> lines(lights.size());
    if (settings_.crossings && lights.size() > 1) lines = share_rays(context, numbers, lights);
    for (std::size_t i = 0; i < lights.size(); ++i)
        if (!scatter(context, numbers, lights[i], std::move(lines[i]), image)) return false;
    return true;
}

template <bool Media>
void SingleScatteringEstimator<Media>::add_statistics(Statistics& statistics) const {
    counters_.report(statistics, Media);
    if (!Media) return;
    statistics.values["marched_rays"] += double(counts_.rays);
    statistics.values["march_steps"] += double(counts_.steps);
    statistics.values["clear_rays"] += double(counts_.clear);
    aids_->add_statistics(statistics);
    statistics.values["lit_pixels"] += double(counts_.candidates);
    if (settings_.sampling == ScatteringSampling::full) return;
    statistics.values["filled_pixels"] += double(counts_.filled);
    statistics.values["screen_space_bytes_peak"] = double(counts_.bytes);
    if (settings_.sampling != ScatteringSampling::epipolar) return;
    statistics.values["epipolar_lines"] += double(counts_.lines);
    statistics.values["epipolar_texels"] += double(counts_.texels);
    if (settings_.crossings) statistics.values["shared_rays"] += double(counts_.shared);
}

}  // namespace

std::unique_ptr<Estimator> make_single_scattering_estimator(const Scene& scene, const RenderOptions& options,
                                                            const ScatteringSettings& settings) {
    if (scene.has_media()) return std::make_unique<SingleScatteringEstimator<true>>(scene, options, settings);
    return std::make_unique<SingleScatteringEstimator<false>>(scene, options, settings);
}

}  // namespace mote::integrators
