#include "gathering/volume_points/medium_samples.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/math/morton.h"
#include "core/math/random.h"

namespace mote::gathering {

using namespace core;

namespace {

glm::ivec3 cells_of(const Bounds3& box, std::uint32_t cells) {
    const Vec3d d = glm::max(Vec3d(box.diagonal()), Vec3d(1e-30));
    const double side = std::cbrt(d.x * d.y * d.z / double(std::max(cells, 1u)));
    return glm::clamp(glm::ivec3(glm::round(d / side)), glm::ivec3(1), glm::ivec3(1024));
}

void sort_along_curve(std::vector<ScatteringPlace>& places, const Bounds3& box) {
    std::vector<std::pair<std::uint64_t, std::size_t>> keyed(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) keyed[i] = {morton_code(places[i].position, box), i};
    std::sort(keyed.begin(), keyed.end());
    std::vector<ScatteringPlace> sorted;
    sorted.reserve(places.size());
    for (const auto& [code, i] : keyed) sorted.push_back(places[i]);
    places = std::move(sorted);
}

}  // namespace

Bounds3 media_box(const RayQueries& scene) {
    Bounds3 box;
    for (const auto& medium : scene.media())
        if (!medium->traits().empty) box.extend(scene.medium_extent(*medium));
    const Bounds3 all = scene.bounds();
    return {glm::max(box.lower, all.lower), glm::min(box.upper, all.upper)};
}

MediumSamples sample_media(const Bounds3& box, std::uint32_t cells, std::uint64_t key,
                           const MediumStateAt& state_at, CancelToken cancelled) {
    MediumSamples samples;
    if (box.empty()) return samples;
    const glm::ivec3 size = cells_of(box, cells);
    const Vec3 cell = box.diagonal() / Vec3(size);
    const std::size_t row = std::size_t(size.x), rows = std::size_t(size.y) * std::size_t(size.z);
    samples.cell_volume = double(cell.x) * double(cell.y) * double(cell.z);
    std::vector<Rgb> extinction(row * rows, Rgb(0.0f));
    std::vector<std::vector<ScatteringPlace>> of_row(rows);
    tbb::parallel_for(std::size_t(0), rows, [&](std::size_t r) {
        cancelled.check();
        const int y = int(r) % size.y, z = int(r) / size.y;
        for (int x = 0; x < size.x; ++x) {
            const std::size_t i = r * row + std::size_t(x);
            Rng rng(hash_keys(key, i));
            const Vec3 u(rng.next_float(), rng.next_float(), rng.next_float());
            const Vec3 p = glm::min(box.lower + cell * (Vec3(x, y, z) + u), box.upper);
            const MediumState state = state_at(p);
            if (!state.current()) continue;
            const MediumCoefficients here = state.current()->coefficients(p);
            extinction[i] = here.sigma_t;
            if (!is_black(here.sigma_s)) of_row[r].push_back({p, state, here.sigma_s});
        }
    });
    samples.extinction = ExtinctionGrid(box, size, std::move(extinction));
    for (const auto& places : of_row)
        samples.places.insert(samples.places.end(), places.begin(), places.end());
    sort_along_curve(samples.places, box);
    return samples;
}

}  // namespace mote::gathering
