#include <nlohmann/json.hpp>

#include "core/meshes/model_archive.h"
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
    case MeshFormat::three_mf: return {"3mf", "model/3mf"};
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
    case PictureFormat::webp: return {"webp", "image/webp"};
  }
  return {"", "application/octet-stream"};
}

FormatNames names_of(const AssetStore::Asset& asset) {
  if (const auto* const mesh = std::get_if<AssetStore::Asset::Mesh>(&asset.content)) {
    const FormatNames names = names_of(mesh->format, asset.bytes);
    return ModelArchive::is_archive(asset.bytes) ? FormatNames{names.name, "application/zip"} : names;
  }
  return names_of(std::get<AssetStore::Asset::Picture>(asset.content).format);
}

nlohmann::ordered_json json_of(const std::string& id, const AssetStore::Asset& asset) {
  nlohmann::ordered_json json = {{"id", id}, {"format", names_of(asset).name}, {"bytes", asset.bytes.size()}};
  if (const auto* const mesh = std::get_if<AssetStore::Asset::Mesh>(&asset.content)) {
    json["vertices"] = mesh->vertices;
    json["triangles"] = mesh->triangles;
    json["notes"] = mesh->notes;
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
  constexpr Operation::Parameter kAssetId{"sha256", "path", "SHA-256 of the bytes, 64 hexadecimal digits"};
  const Operation::Content asset{"application/json", "Asset"};
  const RouteBody body{.limit = {app.settings().asset_bytes, "asset_bytes"}, .require = require_asset};
  router
      .add("PUT", "/v1/assets/{sha256}", Scope::write, LogLevel::info, body,
           [&app](Request& request) { return put_asset(app, request); })
      .describe({.id = "keep_asset",
                 .summary =
                     "Stores a mesh (OBJ, PLY, STL, 3MF, glTF, ZIP) or an image (EXR, HDR, PNG, JPEG, WebP) "
                     "under its SHA-256",
                 .description = "A ZIP archive contains one model and the files that the model names",
                 .parameters = {kAssetId},
                 .body = {"*/*"},
                 .answers = {{200, "The asset was already stored", {"Location", "ETag"}, {asset}},
                             {201, "The asset is stored", {"Location", "ETag"}, {asset}}}});
  router
      .add("GET", "/v1/assets/{sha256}", Scope::read, LogLevel::info,
           [&app](Request& request) { return get_asset(app, request); })
      .describe({.id = "get_asset",
                 .summary = "Returns the file of an asset",
                 .parameters = {kAssetId},
                 .etag = Operation::ETag::always,
                 .answers = {{200,
                              "The file",
                              {},
                              {{"model/obj"},
                               {"model/stl"},
                               {"model/gltf-binary"},
                               {"model/gltf+json"},
                               {"application/zip"},
                               {"image/x-exr"},
                               {"image/vnd.radiance"},
                               {"image/png"},
                               {"image/jpeg"},
                               {"image/webp"},
                               {"application/octet-stream"}}}}});
  router
      .add("DELETE", "/v1/assets/{sha256}", Scope::write, LogLevel::info,
           [&app](Request& request) { return remove_asset(app, request); })
      .describe({.id = "forget_asset",
                 .summary = "Removes an asset",
                 .description =
                     "Allowed for clients that stored the asset and for tokens with the scope admin. The "
                     "asset is deleted when its last client has removed it",
                 .parameters = {kAssetId},
                 .answers = {{204, "The client no longer holds the asset"}}});
}

}  // namespace orrery
