#include "core/load/load.h"
#include "core/params/params.h"
#include "core/plan/options.h"

namespace orrery {
namespace {

std::string_view summary_of(Section section) {
  switch (section) {
    case Section::camera: return "Camera position on its orbit.";
    case Section::image: return "Image size.";
    case Section::render: return "Render options.";
    case Section::budget: return "Error and time budget.";
  }
  return "";
}

void read_settings(Params& p, RenderSettings& settings) {
  for (const Section section : kSections)
    p.optional_object(name_of(section), summary_of(section),
                      [&](Params& inside) { read_request_options(inside, section, settings); });
}

}  // namespace

RenderRequest read_request(const Document& document, const std::function<void(Params&)>& more) {
  RenderRequest request;
  read_document(document, [&](Params& p) {
    p.any("scene", "Scene.");
    p.any("scene_id", "Id of a stored scene, instead of `scene`.");
    read_settings(p, request);
    if (more) more(p);
  });
  return request;
}

std::string request_schema() {
  RenderSettings settings;
  return describe("request.json", "orrery request", "Options of a request.",
                  [&](Params& p) { read_settings(p, settings); });
}

}  // namespace orrery
