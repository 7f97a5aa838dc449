// Mitsuba's .vol files: a dense grid of one or three float channels.
//
// Layout (little-endian): "VOL", version byte 3, int32 type (1 = float32), int32 nx ny nz channels, six
// floats of bounds (lower, upper), then the voxels with x fastest, channels interleaved.
#pragma once

#include <string>
#include <vector>

#include "core/math/bounds.h"
#include "core/objects/memory_budget.h"

namespace mote::media {

struct VolFile {
    glm::ivec3 resolution{0};
    int channels = 1;  ///< 1 or 3
    core::Bounds3 bounds;
    std::vector<float> values;
    std::size_t clamped = 0;  ///< negative voxels raised to 0
    float lowest = 0.0f;      ///< the most negative value met
};

/// Throws InputError naming the file when it is not a complete .vol file of a supported kind, when its size
/// does not match its header, or when it holds NaN, infinite or (unless `clamp_negative`) negative voxels.
VolFile read_vol_file(const std::string& path, bool clamp_negative, const core::MemoryBudget& memory = {});

/// For tests and exports. `values` as in VolFile. Throws InputError when the file cannot be written.
void write_vol_file(const std::string& path, const VolFile& file);

}  // namespace mote::media
