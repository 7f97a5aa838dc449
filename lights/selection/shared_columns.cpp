#include "lights/selection/shared_columns.h"

#include <tbb/parallel_for.h>

#include <numeric>

namespace mote::lights {

using namespace core;

namespace {

constexpr std::size_t lights_a_group = 8;
constexpr std::uint32_t nobody = 0xffffffffu;

Place place_of_light(const VirtualPointLight& vpl) { return {vpl.position, vpl.normal}; }

/// [m^2]; `turn` is what a right angle between normals counts, halved.
float unlike(const Place& a, const Place& b, float turn) {
    const Vec3 d = a.position - b.position, n = a.normal - b.normal;
    return glm::dot(d, d) + turn * glm::dot(n, n);
}

}  // namespace

SharedColumns::SharedColumns(const VplSet& vpls, MatrixSelection found) : found_(std::move(found)) {
    for (std::uint32_t j = 0; j < vpls.lights.size(); ++j) {
        energies_.push_back(energy_of(vpls, j));
        if (!(energies_.back() > 0.0f)) continue;
        places_.push_back(place_of_light(vpls.lights[j])), lights_.push_back(j);
    }
    tree_ = PlaceTree(places_, (places_.size() + lights_a_group - 1) / lights_a_group);
}

/// Of its group in the tree, which is near enough.
std::size_t SharedColumns::nearest(const Place& place) const {
    const auto group = tree_.group(tree_.find(place));
    float extent = 0.0f;
    for (const std::uint32_t i : group)
        extent = std::max(extent, unlike(places_[i], places_[group[0]], 0.0f));
    std::size_t best = group[0];
    for (const std::uint32_t i : group)
        if (unlike(places_[i], place, extent) < unlike(places_[best], place, extent)) best = i;
    return lights_[best];
}

MatrixSelection SharedColumns::for_lights(const VplSet& vpls) const {
    std::vector<std::uint32_t> like(vpls.lights.size(), nobody);
    constexpr std::size_t task = 1024;
    tbb::parallel_for(std::size_t(0), (like.size() + task - 1) / task, [&](std::size_t t) {
        for (std::size_t j = t * task; j < std::min((t + 1) * task, like.size()); ++j)
            if (tree_.groups() > 0 && energy_of(vpls, j) > 0.0f)
                like[j] = std::uint32_t(nearest(place_of_light(vpls.lights[j])));
    });
    std::vector<ColumnDraws> draws(found_.slices());
    tbb::parallel_for(std::size_t(0), draws.size(),
                      [&](std::size_t s) { draws[s] = slice_for(vpls, like, s); });
    return {found_.tree(), std::move(draws)};
}

/// Where there was no light at all to be like, all are one cluster.
ColumnDraws SharedColumns::slice_for(const VplSet& vpls, std::span<const std::uint32_t> like,
                                     std::size_t slice) const {
    const ColumnDraws& own = found_.slice(slice);
    std::vector<std::uint32_t> cluster_of(energies_.size(), 0);
    std::vector<float> weight_of(energies_.size(), 0.0f);
    const ColumnClusters& old = own.clusters();
    for (std::size_t k = 0; k < old.size(); ++k)
        for (std::size_t i = old.first[k]; i < old.first[k + 1]; ++i) {
            const std::uint32_t j = old.members[i];
            cluster_of[j] = std::uint32_t(k);
            if (energies_[j] > 0.0f) weight_of[j] = float(own.weight(i) / double(energies_[j]));
        }
    std::vector<float> weights(like.size());
    std::vector<std::size_t> first(std::max<std::size_t>(old.size(), 1) + 1, 0);
    const auto cluster = [&](std::size_t j) { return like[j] == nobody ? 0 : cluster_of[like[j]]; };
    for (std::size_t j = 0; j < like.size(); ++j) {
        const float energy = energy_of(vpls, j);
        if (!(energy > 0.0f)) continue;
        weights[j] = like[j] == nobody ? energy : weight_of[like[j]] * energy;
        ++first[cluster(j) + 1];
    }
    std::partial_sum(first.begin(), first.end(), first.begin());
    ColumnClusters clusters;
    clusters.members.resize(first.back());
    std::vector<std::size_t> next(first.begin(), first.end() - 1);
    for (std::uint32_t j = 0; j < like.size(); ++j)
        if (energy_of(vpls, j) > 0.0f) clusters.members[next[cluster(j)]++] = j;
    for (std::size_t k = 0; k + 1 < first.size(); ++k)
        if (first[k + 1] > first[k]) clusters.first.push_back(first[k + 1]);
    return {std::move(clusters), weights};
}

std::size_t SharedColumns::memory_bytes() const {
    return found_.memory_bytes() + places_.size() * (sizeof(Place) + 2 * sizeof(std::uint32_t)) +
           energies_.size() * sizeof(float);
}

}  // namespace mote::lights
