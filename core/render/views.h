#pragma once

#include <string>

#include "core/image/encode/files.h"
#include "core/model/film.h"
#include "core/model/plan.h"
#include "core/plan/request.h"

namespace orrery {

// Returns the smallest film storage from which encode_film() can encode the format. EXR with layers requires
// sums.
FilmStorage storage_for(FileFormat format, const Plan& plan);

// Throws InputError if layers are requested for a format other than EXR.
void require_layers_kept(const RenderRequest& request, FileFormat format);

// Sets the error metric of a request with a budget to display values if the format is PNG and the metric is
// `auto` or missing. Throws InputError for an error budget with JPEG, because its compression error has no
// bound, and for a budget with a view other than `picture`.
void choose_space(RenderRequest& request, FileFormat format);

// Encodes the film. PNG and JPEG contain its radiance as sRGB. EXR contains radiance as R, G and B, and each
// channel as a layer of the same name ("normal.X"), all as 32-bit floats. Equal films give equal bytes.
// Thread-safe. PNG and EXR encoding throw Cancelled, see checkpoint(). Also throws std::bad_alloc,
// and a std::exception that is not an Error if the codec fails. REQUIRES: all tiles of the film were stored,
// and its storage is at least storage_for().
std::string encode_film(const Film& film, FileFormat format, const PngOptions& png = {});

}  // namespace orrery
