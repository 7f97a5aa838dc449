// Screen-space bias compensation for the channels of any picture, of whatever renderer.
#pragma once

#include <string>
#include <vector>

#include "core/film/image_channels.h"
#include "screenspace/ssbc/ssbc_layers.h"

namespace mote::screenspace {

/// Names of the layers of the picture, each with three channels, .X .Y .Z or .R .G .B. Empty: the first of
/// the names here that the picture has. Those of Center were taken at pixel centres; the others may be
/// filtered as the picture is, which leaves no sharp edges between surfaces.
struct SsbcChannels {
    std::string position;     ///< `Center.P`, `P`
    std::string normal;       ///< `Center.N`, `N`
    std::string reflectance;  ///< `Center.DiffuseAlbedo`, `DiffuseAlbedo`, `Albedo`
    /// Layers that add up to the light that surfaces reflect. Empty: `direct` and `indirect...` where the
    /// picture has them, otherwise the picture less its layer `emission`.
    std::vector<std::string> light;
};

/// A picture as compensate() wants it.
struct SsbcPicture {
    SsbcSurfaces surfaces;           ///< that it shows
    std::vector<HiddenSide> hidden;  ///< sides that the picture does not show, where they are known
    std::vector<core::Rgb> light;    ///< that they reflect, by pixel
    std::string light_from;          ///< the layers that were taken for it, in words
};

/// The light that surfaces reflect. Throws InputError naming the layers that are missing.
SsbcPicture read_light(const core::ImageChannels& image, const SsbcChannels& channels);

/// Light that a hidden side reflects, from the layer hidden_light_NAME that `mote_vpl` writes
/// (hidden_side_name()). Throws InputError where there is none.
std::vector<core::Rgb> read_hidden_light(const core::ImageChannels& image, std::size_t side);

/// The light of a picture with its surfaces. The camera is that of the attribute worldToCamera, or stands at
/// the origin where positions are in camera space, as some renderers write them. Reflectances above 1 by
/// rounding, less than 1e-3, are cut off. Throws InputError naming all channels that are missing, for
/// positions that no camera fits, and for reflectances that are none.
SsbcPicture read_ssbc_picture(const core::ImageChannels& image, const SsbcChannels& channels);

}  // namespace mote::screenspace
