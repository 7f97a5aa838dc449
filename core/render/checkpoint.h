// Checkpoints: everything needed to continue a render to the very same bits, in one file.
//
// A head (headed_file.h) with the seed, the picture's size, the layers' names, the content hash and the
// control passes, where there are any; the film.
#pragma once

#include <cstdint>
#include <string>

#include "core/film/control_passes.h"
#include "core/film/film.h"

namespace mote::core {

/// Properties that a checkpoint must share with the render that continues it.
struct CheckpointKey {
    std::string content_hash;
    std::uint64_t seed = 0;
};

/// Throws InputError unless a checkpoint of a render with this content hash, whatever its seed, may be
/// written at `path`: nothing stands there, or a file that begins as such a checkpoint.
void require_own_checkpoint(const std::string& path, const std::string& content_hash);
/// Removes the file where require_own_checkpoint() accepts it; everything else stays.
void remove_checkpoint(const std::string& path, const std::string& content_hash);

/// Writes the file atomically. Throws InputError with the system's reason, and where
/// require_own_checkpoint() does; what stood there stays as it was.
void write_checkpoint(const std::string& path, const CheckpointKey& key, const Film& film,
                      const MemoryBudget& memory = {}, const ControlPasses& controls = {});

/// Fills `film`, and `controls` where they can be chosen and the file has control passes. Returns false when
/// there is no such file. Throws InputError when the file is damaged or belongs to another render; the film
/// is unchanged then.
bool read_checkpoint(const std::string& path, const CheckpointKey& key, Film& film, ControlPasses& controls);
/// Without control passes.
bool read_checkpoint(const std::string& path, const CheckpointKey& key, Film& film);

}  // namespace mote::core
