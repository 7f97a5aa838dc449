#include "lights/guiding/choose_scattering.h"

#include <array>

namespace mote::lights {

using namespace core;

namespace {

/// A place, and the numbers on which its choice depends.
struct WeightedPlace {
    double weight, importance;  ///< w; w L
    float indirect;             ///< ExpectedRadiance::indirect
};

/// The places of a segment, and sums over them.
struct Places {
    std::array<WeightedPlace, ScatteringPoints::max_candidates + 1> all;  // filled up to `count` alone
    std::size_t count = 0;
    double weight = 0.0, importance = 0.0, expected = 0.0;
    bool known = true;

    void add(const Rgb& weight_of_path, const ExpectedRadiance& radiance) {
        const auto w = double(average(weight_of_path));
        const WeightedPlace& place = all[count++] = {w, w * double(radiance.root_square), radiance.indirect};
        weight += place.weight, importance += place.importance;
        expected += w * double(radiance.mean), known &= radiance.known;
    }
    double probability(const WeightedPlace& place) const {
        const double by_extinction = place.weight / weight, d = double(extinction_share);
        return importance > 0.0 ? (1.0 - d) * place.importance / importance + d * by_extinction
                                : by_extinction;
    }
    /// By `u`; the last possible one ends what rounding leaves over.
    std::size_t choose(double u) const {
        std::size_t chosen = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const double p = probability(all[i]);
            if (!(p > 0.0)) continue;
            chosen = i;
            if (u < p) break;
            u -= p;
        }
        return chosen;
    }
};

}  // namespace

ScatteringChoice choose_scattering(std::span<const ScatteringPoint> candidates, const Rgb& behind,
                                   const Vec3& surface, const ScatteringGuide& guide, float u) {
    Places places;
    for (const ScatteringPoint& c : candidates) places.add(c.weight, guide.expected(c.position, false));
    if (!is_black(behind)) places.add(behind, guide.expected(surface, true));
    if (!(places.weight > 0.0)) return {};
    const std::size_t chosen = places.choose(double(u));
    const WeightedPlace& place = places.all[chosen];
    return {chosen,
            float(places.probability(place)),
            float(place.weight / places.weight),
            float(places.expected),
            place.indirect,
            places.known};
}

}  // namespace mote::lights
