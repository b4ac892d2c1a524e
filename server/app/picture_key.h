#pragma once

#include <string>

#include "core/model/scene.h"
#include "core/plan/request.h"
#include "server/app/orbit.h"

namespace orrery {

// Returns the same text for all requests that give the same image of the scene, however they are written.
// Missing options take the scene's values. Options that change no pixel are left out.
std::string canonical_request(const Scene& scene, const RenderRequest& request);

// Returns the same text for all requests that give the same image by the same work. Includes the options that
// change no pixel.
std::string canonical_work(const Scene& scene, const RenderRequest& request);

// Returns the hash of the scene and canonical_work(), the key of work in progress. Requests for the same
// pixels with different acceleration structures do not share work, because one may take 1,000 times as long.
std::string work_key(const Scene& scene, const RenderRequest& request);

// Returns the same text for all orbits with the same frames by the same work.
std::string canonical_orbit(const Scene& scene, const OrbitPath& path, int frames);

// Returns a strong ETag with its quotes: the hash of the scene, the canonical request and the version of the
// images.
std::string etag_of(const Scene& scene, const RenderRequest& request);

}  // namespace orrery
