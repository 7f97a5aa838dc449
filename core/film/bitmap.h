// A bitmap in memory.
#pragma once

#include <vector>

#include "core/math/vec.h"

namespace mote::core {

/// Linear RGB of every pixel.
struct Bitmap {
    int width = 0, height = 0;  ///< [pixels]
    std::vector<Rgb> pixels;    ///< row by row from the top
};

}  // namespace mote::core
