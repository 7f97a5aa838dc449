// Settings of guided paths, and their rows.
#pragma once

#include <cstdint>

#include "core/parameters/add_type.h"
#include "core/render/plan.h"
#include "core/scene/requirements.h"

namespace mote::integrators {

/// Paths guided by light that is learned first (guided_paths.h): `directions` alone, or all of them, `on`.
enum class Guiding : std::uint8_t { off, automatic, directions, on };

struct GuidingSettings {
    Guiding mode = Guiding::off;
    int passes = 63;               ///< of training; all but the first seven are the picture's
    int paths = 16384;             ///< of a training pass, that are learned from
    double leaf_samples = 8000.0;  ///< a leaf of the field with more is split
    double memory = 64.0;          ///< of the fields [MiB]
};

/// Training passes that are none of the picture, 1, 2 and 4: later ones are worth more by far.
inline constexpr int first_training_passes = 7;

const core::ParameterList<GuidingSettings>& guiding_rows();

/// Says what guides paths, and when. `media`: paths see them.
void plan_guiding(core::Plan& plan, const GuidingSettings& settings, const core::Requirements& requirements,
                  bool media);

}  // namespace mote::integrators
