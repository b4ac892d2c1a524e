#include "core/load/load.h"
#include "core/params/params.h"
#include "core/plan/options.h"

namespace orrery {
namespace {

std::string_view summary_of(Section section) {
  switch (section) {
    case Section::camera: return "Where on its orbit the camera stands.";
    case Section::image: return "Size of the picture.";
    case Section::render: return "How the picture is made.";
    case Section::budget: return "How near the picture comes, and how soon.";
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
    p.any("scene", "The scene itself.");
    p.any("scene_id", "Or the id of one sent before.");
    read_settings(p, request);
    if (more) more(p);
  });
  return request;
}

std::string request_schema() {
  RenderSettings settings;
  return describe("request.json", "orrery request", "What a request says beside its scene.",
                  [&](Params& p) { read_settings(p, settings); });
}

}  // namespace orrery
