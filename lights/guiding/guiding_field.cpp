#include "lights/guiding/guiding_field.h"

#include <stdexcept>

namespace mote::lights {

GuidingField::GuidingField(const Settings& settings, const core::MemoryBudget& memory)
    : tree_(settings.leaf_samples, settings.bytes, memory, "the field of guided paths") {}

VmfMixture GuidingField::at(const core::Vec3& position) const {
    return leaves().empty() ? VmfMixture{} : leaves()[leaf_of(position)].at(position);
}

void GuidingField::add(std::vector<GuidingSample>& samples) {
    for (const GuidingSample& s : samples)
        if (!(s.weight >= 0.0f) || !std::isfinite(s.weight) || !(s.inverse_distance >= 0.0f) ||
            !std::isfinite(s.inverse_distance))
            throw std::invalid_argument("a sample of the guiding field has a weight that is no radiance");
    tree_.add(samples);
}

}  // namespace mote::lights
