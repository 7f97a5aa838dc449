// Damage to files, from a seed: the same key gives the same bytes on every machine.
#pragma once

#include <cstdint>

#include "tools/fuzz/formats.h"

namespace mote::fuzz {

/// One of the originals with one to eight injuries: bits and bytes changed, numbers replaced by extreme ones,
/// cut short, pieces removed, doubled, exchanged or taken from another original; in texts also words.
Bytes mutate(const std::vector<Bytes>& originals, const Format& format, std::uint64_t key);

}  // namespace mote::fuzz
