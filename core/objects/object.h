// The base of everything that a scene file can name.
#pragma once

#include <memory>
#include <string>

namespace mote::core {

class Object {
  public:
    virtual ~Object() = default;
    std::string id;  ///< the id given in the scene file, or ""
};

/// The categories of the scene language; the element's tag names the category.
enum class Category {
    bsdf,
    texture,
    shape,
    emitter,
    sensor,
    film,
    rfilter,
    sampler,
    medium,
    phase,
    volume,
    integrator,
    compensation,
    visibility,
    selection
};
inline constexpr int category_count = int(Category::selection) + 1;

}  // namespace mote::core
