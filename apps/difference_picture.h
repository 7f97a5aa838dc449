// A picture, its reference, and their difference, amplified: a bias that no eye finds between two pictures.
#pragma once

#include <string>

#include "core/formats/pictures/image_file.h"

namespace mote::apps {

/// "x4" or "4". Throws UsageError for anything but a number above 0.
double amplification(const std::string& text);

/// Writes the three side by side into a PNG file, all with the exposure that the reference adapts to. The
/// difference of luminance, times `factor`, is red where the image is too bright and blue where it is too
/// dark. Returns a line that says so.
std::string write_difference(const std::string& path, const core::Bitmap& image,
                             const core::Bitmap& reference, double factor);

}  // namespace mote::apps
