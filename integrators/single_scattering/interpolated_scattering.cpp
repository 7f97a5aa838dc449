#include "integrators/single_scattering/interpolated_scattering.h"

#include <algorithm>

#include "screenspace/epipolar/in_scattering_grid.h"

namespace mote::integrators {

using namespace core;
using namespace screenspace;

namespace {

EpipolarPicture::Loop loop_of(const PassContext& context) {
    return [&context](int count, const std::function<void(int)>& body) {
        for_each_tile(count, 1, 1, context.cancelled, [&](int i, int, int, int) { body(i); });
    };
}

}  // namespace

PassNumbers::PassNumbers(const RenderOptions& options, std::uint32_t pass) {
    Sampler sampler(options.sampler, options.seed, pass, ~std::uint64_t(0), 0x65706970u);
    lens = sampler.next_2d(), lines = sampler.next_2d(), march = sampler.next_2d(), grid = sampler.next_2d();
}

/// The film, and as much around it as pixel filters reach.
FilmRectangle InterpolatedScattering::frame() const {
    const double margin = std::max(0.5, double(scene_.film().filter_radius));
    return {Vec2d(-margin), Vec2d(options_.width + margin, options_.height + margin)};
}

/// Counts marched rays. What lies outside the film belongs to its border.
void InterpolatedScattering::show(const std::vector<Vec2d>& places, PassImage& image) const {
    for (const Vec2d& p : places)
        image.at(ScatteringLayer::marched_rays, std::clamp(int(std::floor(p.x)), 0, options_.width - 1),
                 std::clamp(int(std::floor(p.y)), 0, options_.height - 1)) += Rgb(1.0f);
}

/// Adds light_at(film, end, task) to every pixel; where it returns nothing, the pixel's ray is marched.
template <typename LightAt>
bool InterpolatedScattering::upsample(const PassContext& context, const PassNumbers& numbers,
                                      const InScattering& light, const InScatteringRays& source,
                                      PassImage& image, const LightAt& light_at) {
    return loop_.run(context, image, {}, [&](EyeTask<true>& pixels) {
        const auto task = source.start();
        std::uint64_t filled = 0, candidates = 0;
        pixels.for_each_pixel([&](int x, int y) {
            CancelToken(context.cancelled).check();
            const EyePoint& point = points_[std::size_t(y) * std::size_t(options_.width) + std::size_t(x)];
            const RayEnd end =
                lit_end(light, scene_.camera().sample_ray(point.film, numbers.lens), point.surface);
            if (end.dark()) return;
            ++candidates;
            auto scattered = light_at(Vec2d(point.film), end, *task);
            if (!scattered) {
                scattered = task->march(Vec2d(point.film), end).radiance, ++filled;
                if (settings_.show_samples) image.at(ScatteringLayer::marched_rays, x, y) += Rgb(1.0f);
            }
            image.at(ScatteringLayer::single_scattering, x, y) += *scattered;
        });
        const std::lock_guard lock(mutex_);
        counts_.filled += filled, counts_.candidates += candidates;
    });
}

/// The light's lines, marched; null for a light at the eye.
auto InterpolatedScattering::find_lines(const PassNumbers& numbers, const InScattering& light,
                                        const InScatteringRays& source,
                                        const EpipolarPicture::Loop& loop) const -> Lines {
    // Closer to the eye than this, single precision leaves no direction to distinguish lines.
    const double nearest = 1e-5 * std::max(1e-30, double(scene_.bounds().radius()));
    const FilmPoint at = FilmProjection(scene_.camera(), options_.width, options_.height, numbers.lens)
                             .project(Vec3d(light.light_position()), nearest);
    if (at.x == 0.0 && at.y == 0.0 && at.w == 0.0) return nullptr;
    LineSampling sampling = settings_.line;
    sampling.shift = double(numbers.lines.y);
    return std::make_unique<EpipolarPicture>(
        EpipolarLines(at, frame(), settings_.lines, double(numbers.lines.x)), sampling, source, loop);
}

bool InterpolatedScattering::scatter(const PassContext& context, const PassNumbers& numbers,
                                     const InScattering& light, PassImage& image) {
    CancelToken(context.cancelled).check();
    const InScatteringRays source(scene_, light, numbers.lens);
    const auto loop = loop_of(context);
    const bool epipolar = settings_.sampling == ScatteringSampling::epipolar;
    const Lines lines = epipolar ? find_lines(numbers, light, source, loop) : nullptr;
    bool done;
    std::size_t bytes;
    if (lines) {
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
    counts_.unoccluded += source.unoccluded();
    counters_.add(source.rays(), source.tracking());
    return done;
}

bool InterpolatedScattering::run(const PassContext& context, const PassNumbers& numbers,
                                 std::span<const InScattering> lights, PassImage& image) {
    for (const InScattering& light : lights)
        if (!scatter(context, numbers, light, image)) return false;
    return true;
}

void InterpolatedScattering::add_statistics(Statistics& statistics) const {
    statistics.values["lit_pixels"] += double(counts_.candidates);
    statistics.values["filled_pixels"] += double(counts_.filled);
    statistics.values["screen_space_bytes_peak"] = double(counts_.bytes);
    if (settings_.sampling != ScatteringSampling::epipolar) return;
    statistics.values["epipolar_lines"] += double(counts_.lines);
    statistics.values["epipolar_texels"] += double(counts_.texels);
}

}  // namespace mote::integrators
