#include <nlohmann/json.hpp>

#include "server/app/app.h"
#include "server/routes/access.h"
#include "server/routes/answers.h"

// /v1/scenes: scenes stored for repeated renders, by the hash of their content.
namespace orrery {
namespace {

using nlohmann::ordered_json;

ordered_json list_of(const Vec3d& v) { return {v.x, v.y, v.z}; }

ordered_json camera_json(const CameraPlacement& placement, const Camera& camera) {
  ordered_json json = {{"type", camera.type()},
                       {"eye", list_of(placement.eye)},
                       {"look_at", list_of(placement.look_at)},
                       {"up", list_of(placement.up)}};
  for (const auto& [name, value] : camera.parameters()) json[name] = value;
  return json;
}

ordered_json summary(const Scene& scene) {
  ordered_json summary = {{"id", scene.id},
                          {"title", scene.title},
                          {"width", *scene.render.width},
                          {"height", *scene.render.height},
                          {"camera", camera_json(scene.placement, *scene.camera)},
                          {"objects", scene.object_count},
                          {"lights", scene.lights.size()}};
  if (!scene.motion.empty())
    summary["motion"] = {{"first_s", scene.motion.first}, {"last_s", scene.motion.last}};
  return summary;
}

std::string etag_of_scene(const Scene& scene) { return "\"" + scene.id + "\""; }

Response add_scene(App& app, Request& request) {
  app.require_open();
  RequestTrace trace;
  SceneStore::KeepResult kept;
  app.read(request.body, caller_of(request), trace, [&](const Document& document, const AssetSource& assets) {
    kept = app.scenes().keep(document, assets, caller_of(request).client);
  });
  const Scene& scene = kept.scene->scene();
  Response response = json_answer(kept.known ? 200 : 201, summary(scene));
  response.set("Location", "/v1/scenes/" + scene.id);
  response.set("ETag", etag_of_scene(scene));
  response.set("Server-Timing", server_timing(trace.timing));
  response.set("Cache-Control", "no-store");
  return response;
}

Response get_scene(App& app, Request& request) {
  const auto prepared = app.scenes().find(request.path_value("id"));
  const Scene& scene = prepared->scene();
  const std::string etag = etag_of_scene(scene);
  Response response{.status = 304};
  if (!has_current(request, etag))
    response = text_response(200, "application/json", {prepared, scene.canonical});
  response.set("ETag", etag);
  response.set("Cache-Control", "no-cache");  // the scene may be removed, so clients must revalidate
  return response;
}

Response remove_scene(App& app, Request& request) {
  app.scenes().remove(request.path_value("id"), request.client, may_remove_others(app.access(), request));
  return {.status = 204};
}

}  // namespace

void add_scenes_routes(Router& router, App& app) {
  const Operation::Content summary{"application/json", "SceneSummary"};
  router
      .add("POST", "/v1/scenes", Scope::write, LogLevel::info, json_body(app),
           [&app](Request& request) { return add_scene(app, request); })
      .describe({.id = "keep_scene",
                 .summary =
                     "Stores a scene in memory under the SHA-256 of its canonical JSON, until the service "
                     "stops or a full store evicts it",
                 .body = {"application/json", "/schemas/scene.json"},
                 .answers = {{200, "The scene was already stored", {"Location", "ETag"}, {summary}},
                             {201,
                              "The scene is stored; it may have been rendered before",
                              {"Location", "ETag"},
                              {summary}}}});
  router
      .add("GET", "/v1/scenes/{id}", Scope::read, LogLevel::info,
           [&app](Request& request) { return get_scene(app, request); })
      .describe({.id = "get_scene",
                 .summary = "Returns the scene as canonical JSON",
                 .parameters = {kSceneId},
                 .etag = Operation::ETag::always,
                 .answers = {{200, "The scene", {}, {{"application/json", "/schemas/scene.json"}}}}});
  router
      .add("DELETE", "/v1/scenes/{id}", Scope::write, LogLevel::info,
           [&app](Request& request) { return remove_scene(app, request); })
      .describe({.id = "forget_scene",
                 .summary = "Removes a scene",
                 .description =
                     "Allowed for clients that posted the scene and for tokens with the scope admin. "
                     "The scene is deleted when its last client has removed it",
                 .parameters = {kSceneId},
                 .answers = {{204, "The client no longer holds the scene"}}});
}

}  // namespace orrery
