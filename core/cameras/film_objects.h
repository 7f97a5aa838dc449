// Film, reconstruction filter and sampler as the scene file describes them. They hold settings only: the
// image itself is core/film/film.h, the filter core/render's PixelFilter, the sampler core/math/sampler.h.
#pragma once

#include "core/parameters/add_type.h"

namespace mote::core {

struct FilterSettings {
    std::string name = "gaussian";
    float radius = 2.0f, stddev = 0.5f;  ///< pixels
};

struct SamplerSettings {
    std::string kind = "sobol";
    int sample_count = 16;
};

struct FilmFormat {
    int width = 768, height = 576;  ///< pixels
    bool half = false;              ///< write float16
    bool interval = false;          ///< FilmSettings::interval
    FilterSettings filter;
};

/// hdrfilm; box, tent, gaussian; independent, sobol.
void register_film_objects(Registry& registry);

}  // namespace mote::core
