#pragma once

#include <string>

#include "core/model/scene.h"
#include "core/plan/request.h"
#include "server/rendering/orbit.h"

namespace orrery {

// Returns a canonical text, which is equal for all requests that give the same image of the scene. Missing
// options have the scene's values. Options that do not change pixels are left out.
std::string canonical_request(const Scene& scene, const RenderRequest& request);

// Returns canonical_request() with all options, including those that do not change pixels.
std::string canonical_work(const Scene& scene, const RenderRequest& request);

// Returns the key under which requests share a render: the hash of the scene and canonical_work(). Requests
// with different acceleration structures do not share a render, because one may take 1,000 times as long.
std::string work_key(const Scene& scene, const RenderRequest& request);

// Returns a canonical text, which is equal for all orbits with the same frames and options.
std::string canonical_orbit(const Scene& scene, const OrbitPath& path, int frames);

// Returns a strong ETag in quotes: the hash of the scene, canonical_request() and kPictures, the version of
// the rendered images.
std::string etag_of(const Scene& scene, const RenderRequest& request);

}  // namespace orrery
