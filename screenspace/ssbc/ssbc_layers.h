// Surfaces that the picture does not show, as senders and receivers of screen-space bias compensation: the
// depth peeling that Engelhardt 2013 (Secs. 11.2.3 and 11.5) names as future work.
//
// A layer has two sides, and each is a picture of patches of its own. Of the first layer the picture shows
// one; the other faces what lies behind it. The outer side of a block's back lights the floor behind the
// block and faces away from the viewer; the wall behind faces the viewer. Which sides reflect anything is up
// to the BSDF: a plain diffuse one has one side, a twosided one both. Insides of closed shapes reflect as
// well, but no light comes to them: a hidden patch that has none when the compensation starts takes no part.
// That also keeps it from handing on what leaks in, since visibility is left out here as well.
//
// All sides together are laid out as one tall picture, so that one pyramid holds them and one sum goes over
// them. Only patches look from side to side (ssbc_patches.h).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "screenspace/ssbc/ssbc_surfaces.h"

namespace mote::screenspace {

/// Surfaces that the picture does not show.
struct HiddenSide {
    SsbcSurfaces surfaces;             ///< of the size of the picture
    std::vector<core::Rgb> reflected;  ///< radiance that it reflects, one entry a pixel
};

/// The hidden sides of n layers: behind the first, before and behind each of the others; 2 n - 1 in all.
std::vector<SsbcSurfaces> hidden_sides(std::span<const GBuffer> layers);

/// Number of sides that n layers hide, and their names: "1_back", "2", "2_back", ...
constexpr std::size_t hidden_side_count(int layers) { return layers > 1 ? 2 * std::size_t(layers) - 1 : 0; }
/// Name of one side, counted from 0.
std::string hidden_side_name(std::size_t side);

/// Pictures of one size below each other in a tall one.
struct SideLayout {
    int height = 0;  ///< of each
    int pitch = 0;   ///< rows from the top of one to that of the next
    int sides = 1;   ///< pictures
    int total_height() const { return (sides - 1) * pitch + height; }  ///< of the tall picture [pixels]
};

/// Far enough apart for nodes of the levels that are summed to belong to one side.
SideLayout side_layout(int height, std::size_t hidden);

/// The picture, and below it the hidden sides.
SsbcSurfaces in_one_picture(const SsbcSurfaces& visible, const std::vector<const SsbcSurfaces*>& hidden);

}  // namespace mote::screenspace
