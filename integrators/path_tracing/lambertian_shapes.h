// Shapes whose material is Lambertian reflection and nothing else, the same everywhere on the shape.
#pragma once

#include <vector>

#include "core/scene/scene.h"

namespace mote::integrators {

struct LambertianSides {
    core::Rgb front{0.0f}, back{0.0f};  ///< reflectances
};

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
