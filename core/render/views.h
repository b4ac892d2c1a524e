#pragma once

#include <string>

#include "core/image/files.h"
#include "core/model/film.h"
#include "core/model/plan.h"
#include "core/plan/request.h"

namespace orrery {

// Returns the smallest film storage that a file of that format needs. Layers need sums.
FilmStorage storage_for(FileFormat format, const Plan& plan);

// Throws InputError if layers are requested for a format other than EXR.
void require_layers_kept(const RenderRequest& request, FileFormat format);

// Sets the error metric of a budget if the request leaves it open: displayed values for PNG, else radiance.
// Throws InputError for an error budget with JPEG, whose compression has no error bound.
void choose_space(RenderRequest& request, FileFormat format);

// Encodes the film. PNG and JPEG contain its radiance as sRGB. EXR contains radiance as R, G and B, and each
// channel as a layer of its name ("normal.X"), all as 32-bit floats. The result is deterministic. Has
// interruption points. REQUIRES: the film keeps at least the storage of storage_for().
std::string encode_film(const Film& film, FileFormat format, const PngOptions& png = {});

}  // namespace orrery
