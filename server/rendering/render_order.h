#pragma once

#include <memory>
#include <stop_token>
#include <string>

#include "core/image/encode/files.h"
#include "core/plan/request.h"
#include "server/base/subscribers.h"
#include "server/cache/scene_store.h"
#include "server/telemetry/service_counters.h"

namespace orrery {

// Durations of the steps of a response, in milliseconds.
struct Timing {
  double load = 0, plan = 0, queue = 0, build = 0, render = 0, encode = 0;
};

// Progress of a request: the durations of its steps so far, and the current step.
struct RequestTrace {
  Timing timing = {};
  Stage stage = Stage::read;
};

// Client of a request.
struct Caller {
  std::string client;                             // client that the work is charged to
  std::stop_token gone;                           // stop is requested once no client waits for the result
  std::shared_ptr<Subscribers> subscribers = {};  // all clients of shared work; null: not shared
};

// One image to render: an image of its own, or a frame of an orbit or a job. make_order() is the only
// function that creates orders, so that scene, request and plan always belong together.
struct RenderOrder {
  SceneStore::Prepared scene;
  RenderRequest request;
  FileFormat format;
  Plan plan;
  Caller caller;
  double plan_ms;  // duration of make_order()

  // Returns the key of the image, which does not depend on its format.
  std::string key() const;
};

// Plans the image. Throws the InputError of make_plan(), and InputError if the format cannot store the
// requested layers.
RenderOrder make_order(SceneStore::Prepared scene, RenderRequest request, FileFormat format, Caller caller);

}  // namespace orrery
