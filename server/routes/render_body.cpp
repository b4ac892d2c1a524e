#include "server/routes/render_body.h"

#include "core/load/load.h"
#include "server/routes/answers.h"

namespace orrery {
namespace {

SceneStore::Prepared find(App& app, const Document& id) {
  const std::string text = id.canonical();  // in quotes if it is a string
  if (!text.starts_with('"'))
    throw InputError("/scene_id", "must be a string, the id of a scene (got " + text.substr(0, 40) + ")");
  return app.scenes().find(text.substr(1, text.size() - 2));
}

}  // namespace

RenderBody read_render_body(App& app, Request& request, RequestTrace& trace,
                            const std::function<void(Params&)>& more) {
  RenderBody body;
  app.read(request.body, caller_of(request), trace, [&](const Document& document, const AssetSource& assets) {
    const auto scene = document.member("scene"), id = document.member("scene_id");
    if (scene && id) throw InputError("/scene_id", "cannot be used with \"scene\"");
    if (scene || id) body.request = read_request(document, more);
    body.scene =
        id ? find(app, *id) : app.scenes().get(scene ? *scene : document, assets, caller_of(request).client);
  });
  return body;
}

}  // namespace orrery
