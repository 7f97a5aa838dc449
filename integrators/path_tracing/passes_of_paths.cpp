#include "integrators/path_tracing/passes_of_paths.h"

namespace mote::integrators {

using namespace core;

namespace {

constexpr std::uint32_t training_stream = 0x677569u;  // keeps these paths apart from those of the picture

}  // namespace

EyeRay eye_ray(const Scene& scene, const RenderOptions& options, const PixelFilter& filter,
               const PassOfPaths& pass, std::size_t path) {
    const std::size_t width = std::size_t(options.width), pixels = width * std::size_t(options.height);
    const float shift = to_unit_float(std::uint32_t(hash_keys(options.seed, pass.layout, training_stream)));
    const double position = (double(path) + double(shift)) / double(pass.paths) * double(pixels);
    const std::size_t pixel = std::size_t(position) % pixels;
    const std::atomic<bool> never{false};
    Sampler sampler(options.sampler, options.seed, pass.index, path, training_stream);
    const Rng rng = sampler.make_rng();
    const auto [ray, film] = camera_ray(scene.camera(), PassContext{pass.index, filter, never},
                                        int(pixel % width), int(pixel / width), sampler);
    return {ray, film, sampler, rng};
}

}  // namespace mote::integrators
