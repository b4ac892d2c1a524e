#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/scene.h"

// Scenes for tests, as JSON: built from snippets, read from scenes/, moved and scaled as a whole.
namespace orrery::test {

using Json = nlohmann::json;

// Parses a snippet; for brevity ' may stand for ".
Json json(std::string_view text);

// A scene of this object or these (a JSON list), which need not name a material, seen from [0, 0, 4]; `patch`
// is merged over it (RFC 7386): it may bring lights, materials, another camera. Objects without a material
// get "white", which is rough with kd 1 and ka 1.
Json scene_with(const Json& objects, const Json& patch = Json::object());
Json scene_of(std::string_view objects, std::string_view patch = "{}");  // the same from snippets

std::shared_ptr<const Scene> load(const Json& scene);

// JSON Pointer of the first problem that the loader finds; "accepted" if it finds none.
std::string first_problem(const Json& scene);
std::string first_problem_in_text(std::string_view text);

// scenes/<name>.json.
Json sample(std::string_view name);
// The names of all scenes/*.json, sorted.
std::vector<std::string> sample_names();

// Everything `factor` times as far from the origin and as large, lights as bright at what they light.
// REQUIRES: no material filters light (what remains after one metre does not scale).
Json scaled(Json scene, double factor);
Json without_filters(Json scene);
// Everything moved by `offset`.
Json moved(Json scene, const Vec3d& offset);
// One object alone, scaled about the origin and then moved.
Json placed(Json object, double factor, const Vec3d& offset);
// Left and right exchanged: x becomes -x.
Json mirrored(Json scene);

Json numbers(const Vec3d& v);
Vec3d vector(const Json& three);

}  // namespace orrery::test
