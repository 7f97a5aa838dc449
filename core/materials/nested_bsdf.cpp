#include "core/materials/nested_bsdf.h"

#include <fmt/format.h>

#include "core/objects/error.h"

namespace mote::core {

std::vector<BsdfPtr> NestedBsdfs::exactly(std::size_t count, const Properties& p) const {
    const std::string wanted = count == 1 ? "one nested BSDF" : fmt::format("{} nested BSDFs", count);
    if (nested.size() > count)
        throw InputError(p.type + " holds " + wanted + ", not more", nested[count].where);
    if (nested.size() < count) throw InputError(p.type + " needs " + wanted, p.where);
    std::vector<BsdfPtr> bsdfs;
    for (const auto& one : nested) bsdfs.push_back(one.object);
    return bsdfs;
}

StraightPassage mixed_passage(const StraightPassage& a, const StraightPassage& b, float probability_of_b) {
    StraightPassage both;
    both.stops = (1.0f - probability_of_b) * a.stops + probability_of_b * b.stops;
    const float passes = both.probability();
    if (!(passes > 0.0f)) return both;
    both.weight =
        ((1.0f - probability_of_b) * a.transmittance() + probability_of_b * b.transmittance()) / passes;
    return both;
}

std::optional<BsdfSample> straight_sample(const StraightPassage& passage, const Vec3& wo) {
    if (is_black(passage.weight)) return std::nullopt;
    BsdfSample s{.wi = -wo, .weight = passage.weight, .pdf_solid_angle = 0.0f};
    s.delta = s.transmitted = true;
    return s;
}

}  // namespace mote::core
