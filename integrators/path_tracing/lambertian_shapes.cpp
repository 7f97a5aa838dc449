#include "integrators/path_tracing/lambertian_shapes.h"

namespace mote::integrators {

using namespace core;

LambertianShapes::LambertianShapes(const Scene& scene) : entries_(scene.shapes().size()) {
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        const Shape& shape = *scene.shapes()[i];
        const BsdfTraits traits = shape.bsdf->traits();
        if (!traits.diffuse || traits.textured || traits.pane || shape.tangent_matters) continue;
        const auto front = shape.bsdf->diffuse_reflectance({}, {0.0f, 0.0f, 1.0f});
        const auto back = shape.bsdf->diffuse_reflectance({}, {0.0f, 0.0f, -1.0f});
        if (front && back) entries_[i] = {&shape, {*front, *back}};
    }
}

}  // namespace mote::integrators
