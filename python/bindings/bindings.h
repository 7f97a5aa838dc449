// Shared by the files of the Python module: arrays, and errors with file and line.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/function.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <span>

#include "core/math/vec.h"
#include "session/layers.h"
#include "session/loaded_scene.h"
#include "session/render.h"

namespace mote::python {

namespace nb = nanobind;

using Floats = nb::ndarray<const float, nb::c_contig, nb::device::cpu>;
using Indices = nb::ndarray<const std::uint32_t, nb::c_contig, nb::device::cpu>;
using Pixels =
    nb::ndarray<const float, nb::ndim<3>, nb::c_contig, nb::device::cpu>;  ///< [row][column][channel]
using Mask = nb::ndarray<const std::uint8_t, nb::ndim<2>, nb::c_contig, nb::device::cpu>;  ///< [row][column]

/// A picture as Python has it: what a render returned, what was read, or what was put together.
struct Picture {
    session::Rendered rendered;
};

/// [row][column][3] as colours; empty for none. Throws std::invalid_argument for another shape.
std::vector<core::Rgb> colours(const Pixels& pixels);

void bind_algorithms(nb::module_& m);
void bind_host_light(nb::module_& m);
void bind_errors(nb::module_& m);
void bind_scenes(nb::module_& m);
void bind_pictures(nb::module_& m);
void bind_rendering(nb::module_& m);
void bind_viewing(nb::module_& m);

}  // namespace mote::python
