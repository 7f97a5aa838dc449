// Features as OpenImageDenoise takes them.
#pragma once

#include <vector>

#include "screenspace/denoising/oidn_library.h"

namespace mote::screenspace {

/// Albedos as the library defines them; zero where a value is not finite.
std::vector<core::Rgb> between_0_and_1(std::vector<core::Rgb> values);

bool is_zero(std::span<const core::Rgb> values);  ///< everywhere

/// Features without their noise, which lenses and edges leave. Zeros stay as they are, without a run. Throws
/// InputError where the library fails.
std::vector<core::Rgb> without_noise(const OidnLibrary& library, OidnLibrary::Feature which, int width,
                                     int height, std::vector<core::Rgb> values);

}  // namespace mote::screenspace
