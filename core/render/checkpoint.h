// Checkpoints: everything needed to continue a render to the very same bits, in one file.
//
// A head (headed_file.h) with the seed, the picture's size, the layers' names and the content hash; the film.
#pragma once

#include <cstdint>
#include <string>

#include "core/film/film.h"

namespace mote::core {

/// What a checkpoint must share with the render that continues it.
struct CheckpointKey {
    std::string content_hash;
    std::uint64_t seed = 0;
};

/// Writes the file atomically. Throws InputError with the system's reason; an older checkpoint stays as it
/// was.
void write_checkpoint(const std::string& path, const CheckpointKey& key, const Film& film);

/// Fills `film`. Returns false when there is no such file. Throws InputError when the file is damaged or
/// belongs to another render; the film is unchanged then.
bool read_checkpoint(const std::string& path, const CheckpointKey& key, Film& film);

}  // namespace mote::core
