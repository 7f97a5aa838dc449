// Kernels of the merges of one pass: their radii shrink with passes, and with light paths, by the dimension
// of each.
#pragma once

#include "gathering/photon_maps/progressive_radius.h"
#include "integrators/upbp/upbp_settings.h"

namespace mote::integrators {

/// With more light paths than this in a pass kernels are smaller, so that a query costs no more.
inline constexpr double paths_of_first_radius = 1e4;
/// Beams cross far more often than points lie beside them, and most of their boxes are empty: so many light
/// paths have beams, however many there are, and so many the first radius.
inline constexpr std::size_t max_paths_with_beams = 500;
inline constexpr double paths_of_first_beam_radius = 100.0;

/// A light path is traced for each pixel; so many of them have beams.
inline std::size_t paths_with_beams(std::size_t pixels) { return std::min(pixels, max_paths_with_beams); }

/// Radii and numbers of light paths. `size`: radius of the scene's bounds [m]; 0: they are a point.
/// `light_paths`: fewer than pixels in a trial, with so much larger radii that queries find as many.
inline MergeSettings merges_of_pass(const UpbpSettings& settings, std::uint32_t pass, double size,
                                    std::size_t pixels, std::size_t light_paths, bool media) {
    MergeSettings merging;
    const double first = settings.radius * (size > 0.0 ? size : 1.0);
    const auto set = [&](Merge technique, bool used, int dimensions) {
        const auto count = [&](std::size_t paths) {
            return double(dimensions == 1 ? paths_with_beams(paths) : paths);
        };
        const double n = count(light_paths), of_picture = count(pixels);
        const double few = dimensions == 1 ? paths_of_first_beam_radius : paths_of_first_radius;
        const double fraction = gathering::radius_fraction(pass, settings.alpha, dimensions) *
                                gathering::radius_for_paths(of_picture, few, dimensions) *
                                std::pow(of_picture / n, 1.0 / dimensions);
        merging.radius[std::size_t(technique)] = used ? first * fraction : 0.0;
        merging.light_subpaths[std::size_t(technique)] = n;
    };
    set(Merge::surface, settings.surface, 2);
    set(Merge::point_point_3d, media && settings.point_point, 3);
    set(Merge::point_beam_2d, media && settings.point_beam, 2);
    set(Merge::beam_beam_1d, media && settings.beam_beam, 1);
    return merging;
}

}  // namespace mote::integrators
