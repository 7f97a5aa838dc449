// Film, reconstruction filter and sampler as the scene file describes them. They hold settings only: the
// picture itself is core/film/film.h, the filter core/render's PixelFilter, the sampler core/math/sampler.h.
#pragma once

#include "core/objects/object.h"
#include "core/scene/scene.h"

namespace mote::core {

class Properties;
class Registry;

struct FilterObject final : Object {
    std::string name = "gaussian";
    float radius = 2.0f, stddev = 0.5f;  ///< pixels
};

struct SamplerObject final : Object {
    std::string kind = "sobol";
    int sample_count = 16;
};

struct FilmObject final : Object {
    int width = 768, height = 576;
    bool half = false;
    FilterObject filter;
    float aspect() const { return float(width) / float(height); }
};

void register_film_objects(Registry& registry);

/// What sensor factories need of their nested film; the default film when there is none.
FilmObject film_of_sensor(const Properties& properties);
/// The film, filter and sampler of a sensor as settings of a scene.
FilmSettings film_settings(const Properties& sensor);

}  // namespace mote::core
