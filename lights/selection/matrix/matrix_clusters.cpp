#include "lights/selection/matrix/matrix_clusters.h"

#include <algorithm>

#include "lights/selection/matrix/light_clusters.h"

namespace mote::lights {

using namespace core;

namespace {

SlicePoint point_of(const PathReceiver& r) {
    if (!r.vertex.on_surface()) return {r.vertex.position, Vec3(0.0f)};
    const Vec3& n = r.vertex.hit.geometric_normal;
    return {r.vertex.position, glm::dot(n, r.vertex.wo) > 0.0f ? n : -n};
}

/// Each light by itself.
ColumnSampler all_lights(const VplSet& vpls) {
    ColumnClusters clusters;
    for (std::uint32_t j = 0; j < vpls.lights.size(); ++j) {
        clusters.members.push_back(j);
        clusters.first.push_back(clusters.members.size());
    }
    const std::vector<float> weights(vpls.lights.size(), 1.0f);
    return {std::move(clusters), weights};
}

}  // namespace

std::size_t MatrixSettings::bytes(std::size_t lights) const {
    const std::size_t kept = slices * (sizeof(std::uint32_t) + sizeof(double));
    const std::size_t at_work = rows_a_slice() * sizeof(float) + 4 * sizeof(float) + 2 * sizeof(std::size_t);
    return lights * (kept + at_work);
}

MatrixClusters::MatrixClusters(const RowContext& context, std::span<const PathReceiver> receivers,
                               const MatrixSettings& settings, std::uint64_t key) {
    const std::size_t lights = context.vpls.lights.size();
    if (lights <= settings.columns) {
        samplers_.push_back(all_lights(context.vpls));
        return;
    }
    // Slices follow each other, so that the matrix of no more than one is in memory.
    std::vector<SlicePoint> points;
    for (const PathReceiver& r : receivers) points.push_back(point_of(r));
    tree_ = SliceTree(points, settings.slices);
    samplers_.resize(std::max<std::size_t>(1, tree_.groups()));
    for (std::size_t s = 0; s < samplers_.size(); ++s)
        make_slice(context, receivers, points, s, settings, key);
}

void MatrixClusters::make_slice(const RowContext& context, std::span<const PathReceiver> receivers,
                                std::span<const SlicePoint> points, std::size_t slice,
                                const MatrixSettings& settings, std::uint64_t key) {
    std::vector<PathReceiver> rows;
    if (tree_.groups() > 0) {
        const auto members = tree_.group(slice);
        std::vector<SlicePoint> own;
        for (const std::uint32_t m : members) own.push_back(points[m]);
        const SliceTree strata(own, settings.rows_a_slice());
        Rng rng(hash_keys(key, slice, 0x726f7773ull));
        for (std::size_t g = 0; g < strata.groups(); ++g) {
            const auto stratum = strata.group(g);
            rows.push_back(receivers[members[stratum[rng.next_u32() % stratum.size()]]]);
        }
    }
    const ReducedMatrix matrix = reduced_matrix(context, rows, hash_keys(key, slice));
    Rng rng(hash_keys(key, slice, 0x636f6cull));
    samplers_[slice] = {cluster_lights(matrix, settings.columns, rng, context.cancelled), matrix.weights};
}

std::size_t MatrixClusters::slice_of(const ReceiverLanes& receivers) const {
    if (tree_.groups() == 0) return 0;
    Vec3 position(0.0f), normal(0.0f);
    float count = 0.0f;
    for (int i = 0; i < ReceiverLanes::width; ++i) {
        if (receivers.max_vpl_depth[i] == 0) continue;
        position += receivers.position(i), normal += receivers.geometric_normal(i), count += 1.0f;
    }
    return tree_.find({position / count, normal / count});
}

std::span<const WeightedVpl> MatrixClusters::sample(const ReceiverLanes& receivers, Rng& rng,
                                                    std::vector<WeightedVpl>& sampled) const {
    sampled.clear();
    if (receivers.any_active) samplers_[slice_of(receivers)].sample(rng, sampled);
    return sampled;
}

std::size_t MatrixClusters::memory_bytes() const {
    std::size_t sum = 0;
    for (const ColumnSampler& d : samplers_) sum += d.memory_bytes();
    return sum;
}

}  // namespace mote::lights
