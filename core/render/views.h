#pragma once

#include <string>

#include "core/image/files.h"
#include "core/model/film.h"
#include "core/model/plan.h"
#include "core/plan/request.h"

namespace orrery {

// Returns the smallest film storage from which the format can be encoded. EXR with layers requires sums.
FilmStorage storage_for(FileFormat format, const Plan& plan);

// Throws InputError if layers are requested for a format other than EXR.
void require_layers_kept(const RenderRequest& request, FileFormat format);

// Sets the error metric to display values if the format is PNG and a request with a budget does not specify
// it. Throws InputError for an error budget with JPEG, whose compression error has no bound, and for a budget
// with a view other than `picture`.
void choose_space(RenderRequest& request, FileFormat format);

// Encodes the film. PNG and JPEG contain its radiance as sRGB. EXR contains radiance as R, G and B, and each
// channel as a layer of the same name ("normal.X"), all as 32-bit floats. The result is deterministic. Calls
// interruption_point(). REQUIRES: the film has at least the storage of storage_for().
std::string encode_film(const Film& film, FileFormat format, const PngOptions& png = {});

}  // namespace orrery
