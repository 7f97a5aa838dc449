// Pixels that see several surfaces, put together from their neighbours.
//
// The surface that each sample of such a pixel meets is also seen by neighbours that see nothing else, so the
// pixel is
//   r = 1/n sum_s m_s E(s), (4)
// E(s) being the demodulated light of those neighbours, already filtered. r is wrong by its own sampling and
// by how the light varies between the neighbours, y by its noise; both are weighted by that,
//   f = r + V[r] / (V[r] + V[y]) (y - r), (5)
// so that with many passes y is left. Where a sample has no neighbour, as on a wire thinner than a pixel, E
// is what is seen nearby, with a large variance. Pixels that see one surface which hardly any neighbour sees
// are treated alike. Layers of media are put together from neighbours of the samples' depths.
#pragma once

#include "screenspace/layer_filter/filter_planes.h"

namespace mote::screenspace {

/// `result` holds the filtered layer but for these pixels. Throws Cancelled.
void put_mixed_together(const FilterFeatures& features, const LayerToFilter& layer,
                        const FilterPlanes& planes, FilteredLayer& result, core::CancelToken cancelled);

}  // namespace mote::screenspace
