// A picture in memory: planes of floats by name.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/math/vec.h"

namespace mote::core {

/// A picture of named float channels, row by row from the top.
struct ImageChannels {
    int width = 0, height = 0;                    ///< [pixels]
    std::vector<std::string> names;               ///< "R", "G", "B", "direct.R", "Depth.Z"
    std::vector<std::vector<float>> channels;     ///< one plane per name
    std::map<std::string, std::string> metadata;  ///< attributes of the file, as text

    /// A channel: width * height values.
    void add(const std::string& name, std::vector<float> plane);
    /// Splits an RGB plane into layer.R, layer.G, layer.B (or R, G, B for an empty layer name).
    void add_rgb(const std::string& layer, std::span<const Rgb> pixels);
    const std::vector<float>* find(const std::string& name) const;
    /// The three channels of a layer ("" for the beauty); empty when one is missing.
    std::vector<Rgb> rgb(const std::string& layer) const;
};

}  // namespace mote::core
