#pragma once

#include <stop_token>
#include <string>

#include "core/image/files.h"
#include "core/model/film.h"

namespace orrery {

// The least that a film must keep for a file of that format.
FilmStorage storage_for(FileFormat format);

// A file that shows the film: PNG and JPEG its radiance as sRGB; EXR its radiance as R, G and B, and each
// channel as a layer of its name ("normal.X"), all as 32-bit floats. The same film gives the same bytes.
// Throws Cancelled once `stop` is requested. REQUIRES: the film keeps what storage_for(format) does, or more.
std::string encode_film(const Film& film, FileFormat format, const PngOptions& png = {},
                        std::stop_token stop = {});

}  // namespace orrery
