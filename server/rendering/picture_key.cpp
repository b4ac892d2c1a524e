#include "server/rendering/picture_key.h"

#include "core/base/hash.h"
#include "core/base/version.h"
#include "core/params/params.h"
#include "core/plan/options.h"

namespace orrery {
namespace {

template <class Wanted>
std::string text_of(const RenderSettings& settings, const Wanted& wanted) {
  std::string text;
  for (const RenderOption& option : render_options())
    if (wanted(option)) text += std::string(option.key) + "=" + option.text(settings) + ";";
  return text;
}

}  // namespace

std::string canonical_request(const Scene& scene, const RenderRequest& request) {
  return text_of(resolve(scene, request), [](const RenderOption& o) { return o.changes_pixels; });
}

std::string canonical_work(const Scene& scene, const RenderRequest& request) {
  return text_of(resolve(scene, request), [](const RenderOption&) { return true; });
}

std::string work_key(const Scene& scene, const RenderRequest& request) {
  return sha256_hex(scene.id + "\n" + canonical_work(scene, request));
}

std::string canonical_orbit(const Scene& scene, const OrbitPath& path, int frames) {
  return work_key(scene, path.first) + " " + std::to_string(frames) + " " +
         number_text(path.step_degrees + 0.0) + " " + number_text(path.step_seconds + 0.0);
}

std::string etag_of(const Scene& scene, const RenderRequest& request) {
  const std::string all = scene.id + "\n" + canonical_request(scene, request) + "\n" + std::string(kPictures);
  return "\"" + sha256_hex(all).substr(0, 32) + "\"";
}

}  // namespace orrery
