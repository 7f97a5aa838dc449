#include "integrators/virtual_point_lights/vpl_matrix.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace mote::integrators {

using namespace core;

std::vector<glm::ivec2> spread_pixels(int width, int height, std::size_t count, std::uint64_t key) {
    const double cell = std::max(1.0, std::sqrt(double(width) * double(height) / double(count)));
    const int columns = int(std::ceil(width / cell)), rows = int(std::ceil(height / cell));
    std::vector<glm::ivec2> pixels;
    Rng rng(key);
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const Vec2 u = rng.next_vec2();
            const int x = int((i + double(u.x)) * cell), y = int((j + double(u.y)) * cell);
            if (x < width && y < height) pixels.emplace_back(x, y);
        }
    return pixels;
}

std::size_t eye_paths_for(const lights::MatrixSettings& settings) {
    return std::max<std::size_t>(2048, 4 * settings.slices * settings.rows_a_slice());
}

VplMatrix::VplMatrix(const Scene& scene, const lights::MatrixSettings& settings, std::uint64_t seed)
    : scene_(scene), settings_(settings) {
    if (settings.visibility.kind == lights::RowVisibilitySettings::Kind::imperfect)
        points_ = lights::sample_surface_points(scene, std::size_t(settings.visibility.imperfect.all_points),
                                                hash_keys(seed, 0x726f7773ull));
}

void VplMatrix::make(std::uint32_t pass, const lights::VplSet& vpls,
                     std::span<const lights::MatrixReceiver> receivers, float bound, std::uint64_t key,
                     SharedCounters& counters, CancelToken cancelled) {
    const auto begin = std::chrono::steady_clock::now();
    RayCounters rays;
    TrackingCounters tracking;
    const lights::RowContext context{scene_,   vpls, bound,    settings_.visibility,
                                     &points_, rays, tracking, cancelled};
    pass_.reset(), other_.reset(), shared_ = {};  // of the passes before, whose memory is free now
    shared_ = {vpls, lights::MatrixSelection(context, receivers, settings_, key)};
    pass_ = pass;
    counters.add(rays, tracking);
    receivers_ += receivers.size(), bytes_ = std::max(bytes_, shared_.memory_bytes());
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void VplMatrix::use_for(std::uint32_t pass, const lights::VplSet& vpls) {
    other_.reset();
    if (pass == pass_) return;
    const auto begin = std::chrono::steady_clock::now();
    other_ = shared_.for_lights(vpls);
    bytes_ = std::max(bytes_, shared_.memory_bytes() + other_->memory_bytes());
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void VplMatrix::add_statistics(Statistics& statistics) const {
    statistics.seconds["matrix"] = seconds_;
    statistics.values["matrix_bytes"] = double(bytes_);
    statistics.values["matrix_slices"] = double(selection().slices());
    statistics.values["matrix_receivers"] += double(receivers_);
}

}  // namespace mote::integrators
