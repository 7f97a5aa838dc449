#include "integrators/eye_path/shared_pixels.h"

#include <algorithm>
#include <iterator>

namespace mote::integrators {

using screenspace::LayerKind;

std::vector<std::uint32_t> SharedPixels::again() const {
    const screenspace::Upsampling surfaces = upsampling(LayerKind::surface),
                                  volumes = upsampling(LayerKind::volume);
    std::vector<std::uint32_t> all;
    std::set_union(surfaces.again().begin(), surfaces.again().end(), volumes.again().begin(),
                   volumes.again().end(), std::back_inserter(all));
    return all;
}

void SharedPixels::fill(LayerKind kind, std::span<core::Rgb> light) const { upsampling(kind).fill(light); }

}  // namespace mote::integrators
