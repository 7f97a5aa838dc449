// Films whose pixels are steps of light at random places, for tests of what Sobol points leave of the noise.
#pragma once

#include <cstdint>

#include "core/film/film.h"
#include "core/math/sampler.h"

namespace mote::tests {

/// Where the step of a pixel is, between 0.1 and 0.9: what the mean has above the constant.
inline float step_of(std::size_t pixel) {
    return 0.1f + 0.8f * core::to_unit_float(std::uint32_t(core::hash_keys(7, pixel)));
}

/// size x size pixels, the light of each 1 up to its step, on a constant.
inline core::Film film_of_steps(int size, float constant, core::SamplerKind kind, std::uint64_t seed,
                                std::uint32_t passes, core::PassSplit split) {
    core::Film film(size, size, {{"all", ""}}, false, split);
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        core::PassImage image(size, size, 1);
        for (std::size_t p = 0; p < film.pixels(); ++p) {
            core::Sampler sampler(kind, seed, pass, p);
            image.layer(0)[p] = core::Rgb(sampler.next_1d() < step_of(p) ? constant + 1.0f : constant);
        }
        film.add_pass(image);
    }
    return film;
}

}  // namespace mote::tests
