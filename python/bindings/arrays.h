// Vectors of Python and NumPy, to and from those of mote.
#pragma once

#include <array>
#include <vector>

#include "python/bindings/bindings.h"

namespace mote::python {

using Triple = std::array<double, 3>;
using Vectors = nb::ndarray<const float, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;  ///< [row][3]

inline core::Vec3 vec3(const float* v) { return {v[0], v[1], v[2]}; }
inline core::Vec3 vec3(const Triple& v) { return {float(v[0]), float(v[1]), float(v[2])}; }

/// A NumPy array of these sizes that owns the values.
template <typename T, typename... Sizes>
nb::object array_of(std::vector<T> values, Sizes... sizes) {
    auto* kept = new std::vector<T>(std::move(values));
    const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
    return nb::cast(nb::ndarray<nb::numpy, T>(kept->data(), {std::size_t(sizes)...}, owner));
}

}  // namespace mote::python
