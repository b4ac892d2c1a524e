#include "server/api/catalog.h"

#include <nlohmann/json.hpp>

#include "core/accelerators/registry.h"
#include "core/atmospheres/registry.h"
#include "core/cameras/registry.h"
#include "core/channels/registry.h"
#include "core/environments/registry.h"
#include "core/lights/registry.h"
#include "core/materials/registry.h"
#include "core/shapes/registry.h"
#include "core/techniques/registry.h"
#include "core/textures/registry.h"
#include "server/api/option_json.h"
#include "server/base/embedded.h"

namespace orrery {
namespace {

using nlohmann::ordered_json;

template <class Types>
ordered_json entries_of(const Types& types) {
  ordered_json entries = ordered_json::array();
  for (const auto& type : types) entries.push_back({{"type", type.name}, {"summary", type.summary}});
  return entries;
}

ordered_json channels() {
  ordered_json entries = ordered_json::array();
  for (const ChannelType& channel : channel_types())
    entries.push_back(
        {{"type", channel.name}, {"summary", channel.summary}, {"components", channel.components}});
  return entries;
}

ordered_json techniques() {
  ordered_json entries = ordered_json::array();
  for (const TechniqueType& technique : technique_types())
    entries.push_back({{"type", technique.name},
                       {"summary", technique.summary},
                       {"origin", technique.origin},
                       {"missing", technique.not_followed}});
  return entries;
}

ordered_json samples() {
  constexpr std::string_view kFolder = "scenes/", kEnding = ".json";
  ordered_json samples = ordered_json::array();
  for (const EmbeddedFile& file : embedded_files()) {
    if (!file.path.starts_with(kFolder) || !file.path.ends_with(kEnding)) continue;
    const std::string name(
        file.path.substr(kFolder.size(), file.path.size() - kFolder.size() - kEnding.size()));
    if (name.find('/') != std::string::npos) continue;  // scenes/schema/scene.json
    const auto scene = nlohmann::json::parse(file.bytes, nullptr, false);
    if (!scene.is_object()) continue;
    samples.push_back({{"name", name},
                       {"title", scene.value("title", name)},
                       {"description", scene.value("description", "")},
                       {"href", file.path}});
  }
  return samples;
}

}  // namespace

ordered_json catalog_json() {
  return {{"samples", samples()},
          {"shapes", entries_of(shape_types())},
          {"materials", entries_of(material_types())},
          {"textures", entries_of(texture_types())},
          {"lights", entries_of(light_types())},
          {"environments", entries_of(environment_types())},
          {"atmospheres", entries_of(atmosphere_types())},
          {"cameras", entries_of(camera_types())},
          {"channels", channels()},
          {"techniques", techniques()},
          {"accelerators", entries_of(accelerator_types())},
          {"defaults", options_json(default_settings())}};
}

}  // namespace orrery
