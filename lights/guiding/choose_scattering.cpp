#include "lights/guiding/choose_scattering.h"

#include <vector>

namespace mote::lights {

using namespace core;

namespace {

/// A place, and what its choice depends on.
struct WeightedPlace {
    double weight = 0.0, importance = 0.0;  ///< w; w L
};

/// Sums over places.
struct PlaceSums {
    double weight = 0.0, importance = 0.0;
    bool known = true;
    WeightedPlace add(const Rgb& weight_of_path, const ExpectedRadiance& radiance) {
        const auto w = double(average(weight_of_path));
        const WeightedPlace place{w, w * double(radiance.root_square)};
        weight += place.weight, importance += place.importance;
        known &= radiance.known;
        return place;
    }
    double probability(const WeightedPlace& place) const {
        const double by_extinction = place.weight / weight, d = double(extinction_share);
        return known && importance > 0.0 ? (1.0 - d) * place.importance / importance + d * by_extinction
                                         : by_extinction;
    }
};

}  // namespace

ScatteringChoice choose_scattering(std::span<const ScatteringPoint> candidates, const Rgb& behind,
                                   const Vec3& surface, const ScatteringGuide& guide, float u) {
    thread_local std::vector<WeightedPlace> places;
    places.clear();
    PlaceSums sums;
    for (const ScatteringPoint& c : candidates)
        places.push_back(sums.add(c.weight, guide.expected(c.position, false)));
    if (!is_black(behind)) places.push_back(sums.add(behind, guide.expected(surface, true)));
    if (!(sums.weight > 0.0)) return {};

    std::size_t chosen = 0;
    double rest = double(u);
    for (std::size_t i = 0; i < places.size(); ++i) {  // the last possible one ends what rounding leaves over
        const double p = sums.probability(places[i]);
        if (!(p > 0.0)) continue;
        chosen = i;
        if (rest < p) break;
        rest -= p;
    }
    return {chosen, float(sums.probability(places[chosen])), float(places[chosen].weight / sums.weight)};
}

}  // namespace mote::lights
