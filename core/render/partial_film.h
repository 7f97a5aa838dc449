// Partial films: the passes that one machine has rendered of a picture that several make together.
//
// A file of its own (headed_file.h) that needs no scene to be read: the layers stand in its head, and a text
// of its writer that names the render.
#pragma once

#include <string>

#include "core/film/film.h"

namespace mote::core {

struct PartialFilm {
    std::string about;  ///< of the writer (apps/partial_render.h)
    Film film;
};

/// Writes the file atomically. Throws InputError with the system's reason.
void write_partial_film(const std::string& path, const PartialFilm& partial);

/// True for a file that begins as a partial film.
bool is_partial_film(const std::string& path);

/// Throws InputError, which names the file, when it cannot be read, is damaged or no partial film.
PartialFilm read_partial_film(const std::string& path);

}  // namespace mote::core
