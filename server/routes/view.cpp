#include <array>
#include <nlohmann/json.hpp>

#include "core/model/model_images.h"
#include "core/params/json.h"
#include "server/api/view_scene.h"
#include "server/routes/answers.h"
#include "server/routes/frame.h"

// POST /v1/view and GET /v1/assets/{sha256}/view.png: the image of a model, without a scene.
namespace orrery {
namespace {

constexpr std::string_view kType = "image/png";

std::vector<std::string_view> view_keys() {
  std::vector<std::string_view> keys;
  for (const ViewParameter& parameter : view_parameters()) keys.push_back(parameter.key);
  return keys;
}

struct ViewQuery {
  RenderRequest request;
  ViewOptions options;
};
ViewQuery read_view_query(const Request& request) {
  nlohmann::json given = nlohmann::json::object();
  for (const std::string_view key : view_keys())
    if (const auto text = find_field(request.query, key)) given[std::string(key)] = *text;
  return {with_view_budget(read_query(request, view_keys())),
          read_view_options(document_of(std::move(given)))};
}

void require_mesh(const AssetStore::Asset& asset) {
  if (!std::holds_alternative<AssetStore::Asset::Mesh>(asset.content))
    throw InputError("", "must be an OBJ, PLY, STL, 3MF or glTF file (got an image)");
}

struct ViewOrder {
  RenderOrder render;
  std::vector<std::string> notes;  // on the model in the state of the view
};
// Orders the image of a stored model.
ViewOrder make_view_order(App& app, const Caller& caller, ViewQuery query, const std::string& id,
                          RequestTrace& trace) {
  SceneStore::Prepared scene;
  std::vector<std::string> notes;
  app.read_assets(caller, trace, [&](const AssetSource& assets) {
    const auto [width, height] = view_size(query.request);
    const ModelStates states =
        read_states(query.options, [&](const ModelState& state) { return assets.model_asset(id, state); });
    notes = notes_of(*states.begin()->second);
    const nlohmann::json json = view_scene(states, {"asset", id, "Model"}, query.options, width, height);
    scene = app.scenes().get(document_of(json), OneModel(states), caller.client);
  });
  return {make_order(std::move(scene), std::move(query.request), FileFormat::png, caller), std::move(notes)};
}

Response post_view(App& app, Request& request) {
  app.require_open();
  RequestTrace trace;
  const Caller caller = caller_of(request);
  ViewQuery query = read_view_query(request);  // reports errors before the model is stored
  const AssetStore::AddResult added = app.add_asset("", request.body, caller);
  require_mesh(*added.asset);
  const auto [order, all_notes] = make_view_order(app, caller, std::move(query), added.id, trace);
  const Rendered rendered = app.renders().render(order, trace);
  Response response = picture_response(kType, rendered, trace);
  set_content_location(response, kType, order.scene->scene(), *rendered.picture, request.prefix);
  response.set("Orrery-Scene-Id", order.scene->scene().id);
  response.set("Orrery-Asset-Id", added.id);
  std::string notes;
  for (const std::string& note : all_notes) notes += (notes.empty() ? "" : "; ") + note;
  if (!notes.empty()) response.set("Orrery-Model-Notes", notes);
  return response.set("Cache-Control", "no-store");
}

Response get_view(App& app, Request& request) {
  RequestTrace trace;
  const std::string& id = request.path_value("sha256");
  AssetStore::require_name(id);
  require_mesh(*app.assets().find(id));  // also reports missing assets
  const RenderOrder order =
      make_view_order(app, caller_of(request), read_view_query(request), id, trace).render;
  // A later version may frame and light models in another way, and the asset may be removed.
  return frame_response(app, request, order, trace, "no-cache");
}

// Returns the JSON Schemas of the query parameters, which live as long as the program.
std::span<const std::string> view_schemas() {
  static const std::vector<std::string> schemas = [] {
    std::vector<std::string> list;
    for (const ViewParameter& parameter : view_parameters()) {
      nlohmann::ordered_json schema{{"type", "string"}, {"default", parameter.fallback}};
      if (!parameter.names.empty()) schema["enum"] = parameter.names;
      list.push_back(schema.dump());
    }
    return list;
  }();
  return schemas;
}

std::vector<Operation::Parameter> described_parameters(std::vector<Operation::Parameter> all = {}) {
  const auto parameters = view_parameters();
  for (std::size_t i = 0; i < parameters.size(); ++i)
    all.push_back({parameters[i].key, "query", parameters[i].help, view_schemas()[i]});
  return all;
}

}  // namespace

void add_view_routes(Router& router, App& app) {
  const Operation::Answer image{.status = 200,
                                .description = "The image",
                                .headers = {"Content-Location"},
                                .content = {{kType}},
                                .has_results = true};
  Operation::Answer image_of_upload = image, image_of_url = image;
  image_of_upload.headers.insert(image_of_upload.headers.end(), {"Server-Timing", "Orrery-Scene-Id",
                                                                 "Orrery-Asset-Id", "Orrery-Model-Notes"});
  image_of_url.headers.push_back("Cache-Control");
  const RouteBody body{.limit = {app.settings().asset_bytes, "asset_bytes"}, .require = refuse_compressed};
  router
      .add("POST", "/v1/view", Scope::write, LogLevel::info, body,
           [&app](Request& request) { return post_view(app, request); })
      .describe({.id = "view_model",
                 .summary = "Renders a model (OBJ, PLY, STL, 3MF, glTF, ZIP) without a scene",
                 .description = "Stores the model as an asset, frames it exactly, lights it and renders it "
                                "until the error is small. A ZIP archive contains one model and the files "
                                "that the model names",
                 .parameters = described_parameters(),
                 .renders = true,
                 .body = {"*/*"},
                 .answers = {image_of_upload}});
  router
      .add("GET", "/v1/assets/{sha256}/view.png", Scope::read, LogLevel::info,
           [&app](Request& request) { return get_view(app, request); })
      .describe({.id = "view_asset",
                 .summary = "Renders a stored model without a scene",
                 .parameters = described_parameters(
                     {{"sha256", "path", "SHA-256 of the bytes, 64 hexadecimal digits"}}),
                 .renders = true,
                 .etag = Operation::ETag::if_it_lasts,
                 .answers = {image_of_url}});
}

}  // namespace orrery
