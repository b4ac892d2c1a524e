#pragma once

#include <string>

#include "core/model/scene.h"
#include "core/plan/request.h"

namespace orrery {

// One text for all requests that lead to the same picture of the scene, however they were written: what is
// not given takes the scene's value; what changes no pixel (accelerator, slice) is left out.
std::string canonical_request(const Scene& scene, const RenderRequest& request);

// A strong ETag, quotes included: the hash of scene, canonical request and program version.
std::string etag_of(const Scene& scene, const RenderRequest& request);

}  // namespace orrery
