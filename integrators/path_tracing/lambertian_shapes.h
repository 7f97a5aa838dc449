// Shapes whose material is Lambertian reflection and nothing else, the same everywhere on the shape.
#pragma once

#include <vector>

#include "core/math/vectorize.h"
#include "core/scene/scene.h"

namespace mote::integrators {

struct LambertianSides {
    core::Rgb front{0.0f}, back{0.0f};  ///< reflectances
};

/// Light passes from wi to wo only where the shading and the geometric normal agree on their sides
/// (ScatteringVertex::eval()), and Lambertian reflection only on one side. Above 0: it does.
inline float reflects(float shading_o, float shading_i, float geometric_o, float geometric_i) {
    const float shading = shading_o * shading_i;
    return core::min_of(shading, geometric_o * geometric_i * shading);
}

class LambertianShapes {
  public:
    explicit LambertianShapes(const core::Scene& scene);
    /// Null: its material is another one, or textured.
    const LambertianSides* of(const core::Shape& shape) const {
        const Entry& entry = entries_[shape.index];
        return entry.shape == &shape ? &entry.sides : nullptr;
    }

  private:
    struct Entry {
        const core::Shape* shape = nullptr;
        LambertianSides sides;
    };
    std::vector<Entry> entries_;  ///< by Shape::index
};

}  // namespace mote::integrators
