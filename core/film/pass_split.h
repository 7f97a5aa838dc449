// Independent parts of the passes of a film, which show its error.
#pragma once

#include <cstdint>

#include "core/film/pass_image.h"

namespace mote::core {

/// Parts of the passes that a film has sums over: none, those of even and of odd index, or eight groups
/// (pass_group_count).
enum class PassSplit : std::uint8_t { whole, halves, groups };

/// True where the film keeps sums over the passes of odd index of a layer whose squares it keeps.
inline bool splits_layer(PassSplit split, const Layer& layer) {
    switch (split) {
        case PassSplit::halves:
            return !layer.auxiliary;
        case PassSplit::groups:
            return layer.missing;
        default:
            return false;
    }
}

/// True where the film keeps block sums of a layer (pass_blocks.h): halves and groups show its variance
/// themselves.
inline bool keeps_blocks(PassSplit split, const Layer& layer) {
    return split == PassSplit::whole && layer.squares && !layer.auxiliary;
}

/// True where the film keeps a layer at twice the resolution (fine_sums.h).
inline bool keeps_fine(PassSplit split, const Layer& layer) {
    return split == PassSplit::whole && layer.fine;
}

}  // namespace mote::core
