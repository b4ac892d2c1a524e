#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/scene.h"

// Test scenes as JSON, built from snippets or read from scenes/, and transformations of whole scenes.
namespace orrery::test {

using Json = nlohmann::json;

// Parses JSON in which ' may be used instead of ".
Json json(std::string_view text);

// Returns a scene of one object or a list of objects, seen from [0, 0, 4]. `patch` is merged into it (RFC
// 7386) and may add lights, materials or another camera. Objects without a material get "white", which is
// rough with kd 1 and ka 1.
Json scene_with(const Json& objects, const Json& patch = Json::object());
Json scene_of(std::string_view objects, std::string_view patch = "{}");  // scene_with() for JSON snippets

std::shared_ptr<const Scene> load(const Json& scene);

// Returns the JSON Pointer of the loader's first problem, or "accepted".
std::string first_problem(const Json& scene);
std::string first_problem_in_text(std::string_view text);

// Returns scenes/<name>.json.
Json sample(std::string_view name);
// Returns the names of all scenes/*.json, sorted.
std::vector<std::string> sample_names();

// Scales a scene about the origin. Irradiance on the objects does not change. REQUIRES: no material filters
// light, because the filter per metre is not scaled.
Json scaled(Json scene, double factor);
Json without_filters(Json scene);
// Moves a scene by `offset`.
Json moved(Json scene, const Vec3d& offset);
// Scales one object about the origin and then moves it.
Json placed(Json object, double factor, const Vec3d& offset);
// Mirrors a scene: x becomes -x.
Json mirrored(Json scene);

Json numbers(const Vec3d& v);
Vec3d vector(const Json& three);

}  // namespace orrery::test
