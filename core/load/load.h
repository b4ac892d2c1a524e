#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "core/model/scene.h"
#include "core/params/document.h"
#include "core/plan/request.h"

namespace orrery {

class Params;

// Reads a scene, strictly; meshes and pictures that it names come from `assets`. Throws InputError with up to
// 20 problems, each with its JSON Pointer; MalformedJson if the text is not JSON.
std::shared_ptr<const Scene> load_scene(const Document& document, const AssetSource& assets = AssetSource());
std::shared_ptr<const Scene> load_scene(std::string_view json, const AssetSource& assets = AssetSource(),
                                        const JsonLimits& limits = {});

// Reads what a request says beside the scene: the render options, in {camera: {...}, image: {...}, render:
// {...}}; see core/plan/options.h. The keys scene and scene_id belong to the caller and are allowed, and
// `more` may read others. Throws as above.
RenderRequest read_request(const Document& document, const std::function<void(Params&)>& more = {});

// The JSON Schemas of scenes and of what requests say beside them, written from the very code that reads
// them.
std::string scene_schema();
std::string request_schema();

}  // namespace orrery
