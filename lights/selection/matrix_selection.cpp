#include "lights/selection/matrix_selection.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/objects/error.h"
#include "lights/selection/light_clusters.h"

namespace mote::lights {

using namespace core;

namespace {

Place place_of(const MatrixReceiver& r) {
    if (!r.vertex.on_surface()) return {r.vertex.position, Vec3(0.0f)};
    const Vec3& n = r.vertex.hit.geometric_normal;
    return {r.vertex.position, glm::dot(n, r.vertex.wo) > 0.0f ? n : -n};
}

/// Each light by itself.
ColumnDraws all_lights(const VplSet& vpls) {
    ColumnClusters clusters;
    for (std::uint32_t j = 0; j < vpls.lights.size(); ++j) {
        clusters.members.push_back(j);
        clusters.first.push_back(clusters.members.size());
    }
    const std::vector<float> weights(vpls.lights.size(), 1.0f);
    return {std::move(clusters), weights};
}

}  // namespace

std::size_t MatrixSettings::bytes(std::size_t lights, std::size_t threads) const {
    const std::size_t kept = slices * (sizeof(std::uint32_t) + sizeof(double));
    const std::size_t at_work = rows_a_slice() * sizeof(float) + 4 * sizeof(float) + 2 * sizeof(std::size_t);
    return lights * (kept + at_work * std::min<std::size_t>(threads, slices));
}

MatrixSelection::MatrixSelection(const RowContext& context, std::span<const MatrixReceiver> receivers,
                                 const MatrixSettings& settings, std::uint64_t key) {
    const std::size_t lights = context.vpls.lights.size();
    if (lights <= settings.columns) {
        draws_.push_back(all_lights(context.vpls));
        return;
    }
    // Slices follow each other, so that the matrices of no more than one are in memory.
    if (const std::size_t bytes = settings.bytes(lights, 1); bytes > settings.max_bytes)
        throw InputError(
            fmt::format("clusters of {} virtual point lights in {} slices take {:.0f} MB, more "
                        "than the {:.0f} MB of max_megabytes",
                        lights, settings.slices, double(bytes) * 1e-6, double(settings.max_bytes) * 1e-6));
    std::vector<Place> places;
    for (const MatrixReceiver& r : receivers) places.push_back(place_of(r));
    tree_ = PlaceTree(places, settings.slices);
    draws_.resize(std::max<std::size_t>(1, tree_.groups()));
    for (std::size_t s = 0; s < draws_.size(); ++s) make_slice(context, receivers, places, s, settings, key);
}

void MatrixSelection::make_slice(const RowContext& context, std::span<const MatrixReceiver> receivers,
                                 std::span<const Place> places, std::size_t slice,
                                 const MatrixSettings& settings, std::uint64_t key) {
    std::vector<MatrixReceiver> rows;
    if (tree_.groups() > 0) {
        const auto members = tree_.group(slice);
        std::vector<Place> own;
        for (const std::uint32_t m : members) own.push_back(places[m]);
        const PlaceTree strata(own, settings.rows_a_slice());
        Rng rng(hash_keys(key, slice, 0x726f7773ull));
        for (std::size_t g = 0; g < strata.groups(); ++g) {
            const auto stratum = strata.group(g);
            rows.push_back(receivers[members[stratum[rng.next_u32() % stratum.size()]]]);
        }
    }
    const ReducedMatrix matrix = reduced_matrix(context, rows, hash_keys(key, slice));
    Rng rng(hash_keys(key, slice, 0x636f6cull));
    draws_[slice] = {cluster_lights(matrix, settings.columns, rng, context.cancelled), matrix.weights};
}

std::size_t MatrixSelection::slice_of(const ReceiverLanes& receivers) const {
    if (tree_.groups() == 0) return 0;
    Vec3 position(0.0f), normal(0.0f);
    float count = 0.0f;
    for (int i = 0; i < ReceiverLanes::width; ++i) {
        if (receivers.max_vpl_depth[i] == 0) continue;
        position += receivers.position(i), normal += receivers.geometric_normal(i), count += 1.0f;
    }
    return tree_.find({position / count, normal / count});
}

std::span<const WeightedVpl> MatrixSelection::draw(const ReceiverLanes& receivers, Rng& rng,
                                                   std::vector<WeightedVpl>& drawn) const {
    drawn.clear();
    if (receivers.any_active) draws_[slice_of(receivers)].draw(rng, drawn);
    return drawn;
}

std::size_t MatrixSelection::memory_bytes() const {
    std::size_t sum = 0;
    for (const ColumnDraws& d : draws_) sum += d.memory_bytes();
    return sum;
}

}  // namespace mote::lights
