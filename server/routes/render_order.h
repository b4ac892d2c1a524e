#pragma once

#include <functional>

#include "server/app/app.h"
#include "server/http/message.h"

namespace orrery {

class Params;

// What a body orders: a scene, written in it or named by its id, and how it is to be seen.
struct RenderOrder {
  SceneStore::Prepared scene;
  RenderRequest request;
};

// Reads {scene or scene_id, camera, image, render} or, if it has neither of the first two, a scene; `more`
// may read other keys of the former. Takes the request's body. Throws what App::read and read_request do.
RenderOrder read_render_order(App& app, Request& request, Timing& timing,
                              const std::function<void(Params&)>& more = {});

}  // namespace orrery
