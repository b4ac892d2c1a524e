#include <nlohmann/json.hpp>

#include "server/app/app.h"
#include "server/routes/access.h"
#include "server/routes/answers.h"

// /v1/assets: mesh and image files, which scenes refer to by SHA-256.
namespace orrery {
namespace {

struct FormatNames {
  const char *name, *media_type;
};

FormatNames names_of(MeshFormat format, const std::string& bytes) {
  switch (format) {
    case MeshFormat::obj: return {"obj", "model/obj"};
    case MeshFormat::stl: return {"stl", "model/stl"};
    case MeshFormat::ply: return {"ply", "application/octet-stream"};
    case MeshFormat::gltf:
      return {"gltf", bytes.starts_with("glTF") ? "model/gltf-binary" : "model/gltf+json"};
  }
  return {"", "application/octet-stream"};
}
FormatNames names_of(PictureFormat format) {
  switch (format) {
    case PictureFormat::exr: return {"exr", "image/x-exr"};
    case PictureFormat::hdr: return {"hdr", "image/vnd.radiance"};
    case PictureFormat::png: return {"png", "image/png"};
    case PictureFormat::jpeg: return {"jpeg", "image/jpeg"};
  }
  return {"", "application/octet-stream"};
}

FormatNames names_of(const AssetStore::Asset& asset) {
  if (const auto* const mesh = std::get_if<AssetStore::Asset::Mesh>(&asset.content))
    return names_of(mesh->format, asset.bytes);
  return names_of(std::get<AssetStore::Asset::Picture>(asset.content).format);
}

nlohmann::ordered_json json_of(const std::string& id, const AssetStore::Asset& asset) {
  nlohmann::ordered_json json = {{"id", id}, {"format", names_of(asset).name}, {"bytes", asset.bytes.size()}};
  if (const auto* const mesh = std::get_if<AssetStore::Asset::Mesh>(&asset.content)) {
    json["vertices"] = mesh->vertices;
    json["triangles"] = mesh->triangles;
  } else {
    const auto& picture = std::get<AssetStore::Asset::Picture>(asset.content);
    json["width"] = picture.width;
    json["height"] = picture.height;
  }
  return json;
}

std::string etag_of(const std::string& id) { return "\"" + id + "\""; }

void require_asset(const Request& request) {
  AssetStore::require_name(request.path_value("sha256"));
  refuse_compressed(request);
}

Response put_asset(App& app, Request& request) {
  app.require_open();
  const std::string id = request.path_value("sha256");
  const AssetStore::AddResult added = app.add_asset(id, request.body, caller_of(request));
  Response response = json_answer(added.known ? 200 : 201, json_of(id, *added.asset));
  response.set("Location", "/v1/assets/" + id);
  response.set("ETag", etag_of(id));
  response.set("Cache-Control", "no-store");
  return response;
}

Response get_asset(App& app, Request& request) {
  const std::string id = request.path_value("sha256");
  const AssetStore::AssetPtr asset = app.assets().find(id);
  Response response{.status = 304};
  if (!has_current(request, etag_of(id))) {
    response = {.status = 200, .body = {asset, asset->bytes}};
    response.set("Content-Type", names_of(*asset).media_type);
  }
  response.set("ETag", etag_of(id));
  response.set("Cache-Control", "no-cache");  // the asset may be removed, so clients must revalidate
  return response;
}

Response remove_asset(App& app, Request& request) {
  app.assets().remove(request.path_value("sha256"), request.client, may_remove_others(app.access(), request));
  return {.status = 204};
}

}  // namespace

void add_assets_routes(Router& router, App& app) {
  const RouteBody body{.limit = {app.settings().asset_bytes, "asset_bytes"}, .require = require_asset};
  router.add("PUT", "/v1/assets/{sha256}", Scope::write, LogLevel::info, body,
             [&app](Request& request) { return put_asset(app, request); });
  router.add("GET", "/v1/assets/{sha256}", Scope::read, LogLevel::info,
             [&app](Request& request) { return get_asset(app, request); });
  router.add("DELETE", "/v1/assets/{sha256}", Scope::write, LogLevel::info,
             [&app](Request& request) { return remove_asset(app, request); });
}

}  // namespace orrery
