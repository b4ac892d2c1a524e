#pragma once

#include <string>

#include "core/model/scene.h"
#include "core/plan/request.h"
#include "server/app/orbit.h"

namespace orrery {

// One text for all requests that lead to the same picture of the scene, however they were written: what is
// not given takes the scene's value; options that change no pixel are left out.
std::string canonical_request(const Scene& scene, const RenderRequest& request);

// Likewise for all that lead to the same picture by the same work: with the options that change no pixel.
std::string canonical_work(const Scene& scene, const RenderRequest& request);

// The same with the scene. What is under way goes by this: a picture that is asked for by a structure which
// takes a thousand times as long must not keep who asks for the same pixels.
std::string work_key(const Scene& scene, const RenderRequest& request);

// Likewise for the frames of an orbit.
std::string canonical_orbit(const Scene& scene, const OrbitPath& path, int frames);

// A strong ETag, quotes included: the hash of scene, canonical request and program version.
std::string etag_of(const Scene& scene, const RenderRequest& request);

}  // namespace orrery
