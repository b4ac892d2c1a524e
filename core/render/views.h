#pragma once

#include <string>

#include "core/image/files.h"
#include "core/model/film.h"
#include "core/model/plan.h"
#include "core/plan/request.h"

namespace orrery {

// The least that a film of the plan must keep for a file of that format: sums where it has layers.
FilmStorage storage_for(FileFormat format, const Plan& plan);

// Throws InputError where layers are asked for in a format that cannot keep them: EXR alone does.
void require_layers_kept(const RenderRequest& request, FileFormat format);

// Has a budget's error told in what the format keeps, where the request does not say: what a screen shows of
// PNG, else radiance. Throws InputError where an error is asked of JPEG: what that leaves out has no bound.
void choose_space(RenderRequest& request, FileFormat format);

// A file that shows the film: PNG and JPEG its radiance as sRGB; EXR its radiance as R, G and B, and each
// channel as a layer of its name ("normal.X"), all as 32-bit floats. The same film gives the same bytes.
// Has interruption points. REQUIRES: the film keeps what storage_for() says, or more.
std::string encode_film(const Film& film, FileFormat format, const PngOptions& png = {});

}  // namespace orrery
