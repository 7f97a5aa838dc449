// Settings of guided paths, and their rows.
#pragma once

#include <cstdint>

#include "core/parameters/add_type.h"
#include "core/render/plan.h"
#include "core/scene/requirements.h"

namespace mote::integrators {

/// Paths guided by light that is learned meanwhile (guided_paths.h).
enum class Guiding : std::uint8_t { off, automatic, on };

struct GuidingSettings {
    Guiding mode = Guiding::off;
    int passes = 2048;             ///< of training at most; then the field is frozen
    int paths = 8192;              ///< of a training pass
    double share = 0.1;            ///< of the picture's counted work that training may take
    double leaf_samples = 8000.0;  ///< a leaf of the field with more is split
    double memory = 64.0;          ///< of the fields [MiB]
    bool vertices = true;          ///< vertices in media, besides directions
};

const core::ParameterList<GuidingSettings>& guiding_rows();

/// Says what guides paths, and when. `media`: paths see them.
void plan_guiding(core::Plan& plan, const GuidingSettings& settings, const core::Requirements& requirements,
                  bool media);

}  // namespace mote::integrators
