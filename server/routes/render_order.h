#pragma once

#include <functional>

#include "server/app/app.h"
#include "server/http/message.h"

namespace orrery {

class Params;

// Scene and render options of a request body.
struct RenderOrder {
  SceneStore::Prepared scene;
  RenderRequest request;
};

// Reads either {scene or scene_id, camera, image, render, budget} or a bare scene. In the first case, `more`
// may read further keys. Consumes the request's body. Throws the errors of App::read() and read_request().
RenderOrder read_render_order(App& app, Request& request, Timing& timing,
                              const std::function<void(Params&)>& more = {});

}  // namespace orrery
