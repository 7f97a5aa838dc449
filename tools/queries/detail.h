// Level of detail by visible pixels: a crowd of balls whose meshes are as fine as the balls are visible.
#pragma once

#include <vector>

namespace mote::queries {

struct DetailSettings {
    int balls = 400, width = 512, height = 512;
    float radius = 0.12f;  ///< [m], in a cube of 2 m
    int finest = 32;       ///< cells from pole to pole; a mesh of n has 4 n (n - 1) triangles
};

struct DetailRow {
    const char* by;  ///< what the level follows
    double triangles = 0;
    double query_seconds = 0;  ///< coarse meshes, their picture, its histogram
    double seconds = 0;        ///< all of it: queries, meshes, the structure for rays, the picture
    double changed = 0;        ///< share of the pixels that show another ball than with the finest meshes
    double hidden = 0;         ///< balls without a visible pixel
};

/// Finest meshes everywhere, by the size on the screen, and by visible pixels.
std::vector<DetailRow> compare_details(const DetailSettings& settings);

}  // namespace mote::queries
