#pragma once

#include <functional>

#include "server/app/app.h"
#include "server/http/message.h"

namespace orrery {

class Params;

// Scene and render options of a request body.
struct RenderBody {
  SceneStore::Prepared scene;
  RenderRequest request;
};

// Reads either {scene or scene_id, camera, image, render, budget} or a bare scene. In the first case, `more`
// may read further keys. Consumes the request's body. Throws the errors of App::read() and read_request().
RenderBody read_render_body(App& app, Request& request, RequestTrace& trace,
                            const std::function<void(Params&)>& more = {});

}  // namespace orrery
