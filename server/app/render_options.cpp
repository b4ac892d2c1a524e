#include "server/app/render_options.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "core/base/number.h"
#include "core/load/load.h"
#include "core/params/json.h"

namespace orrery {
namespace {

constexpr std::array kOptions{
    RenderOption{"azimuth", "camera", "azimuth_degrees", "--azimuth", "DEGREES",
                 "Turn the camera about the scene's up axis"},
    RenderOption{"elevation", "camera", "elevation_degrees", "--elevation", "DEGREES",
                 "Lift the camera toward up; 90 is straight above"},
    RenderOption{"distance", "camera", "distance", "--distance", "FACTOR",
                 "Camera distance as a factor of the scene's own"},
    RenderOption{"pan", "camera", "pan", "--pan", "X,Y,Z", "Move the camera and what it looks at, in metres"},
    RenderOption{"fov", "camera", "fov_degrees", "--fov", "DEGREES", "Vertical angle of the picture"},
    RenderOption{"width", "image", "width", "--width", "PIXELS", "Width of the picture"},
    RenderOption{"height", "image", "height", "--height", "PIXELS", "Height of the picture"},
    RenderOption{"samples", "render", "samples", "--samples", "N", "Rays a pixel"},
    RenderOption{"max_depth", "render", "max_depth", "--depth,--max-depth", "N",
                 "Deepest ray that is traced; camera rays have depth 0"},
    RenderOption{"min_contribution", "render", "min_contribution", "--min-contribution", "WEIGHT",
                 "Rays with less weight are not traced"},
    RenderOption{"technique", "render", "technique", "--technique", "NAME", "How light is followed"},
    RenderOption{"accelerator", "render", "accelerator", "--accelerator", "NAME",
                 "How rays find what they meet, or auto"},
    RenderOption{"precision", "render", "precision", "--precision", "auto|float|double",
                 "Number type of rays"},
    RenderOption{"seed", "render", "seed", "--seed", "N", "Seed of all random choices"},
    RenderOption{"reorder", "render", "reorder", "--reorder", "true|false",
                 "Trace rays together that are alike"},
    RenderOption{"prediction", "render", "prediction", "--prediction", "NAME",
                 "Who proposes what may shadow a point: none, network, last or random"},
    RenderOption{"time", "render", "time", "--time", "SECONDS", "Moment of what moves"},
};

// A number, a truth value or a list of these with commas between them, if the text is one and nothing else,
// or else the text, which the reader then refuses in words.
nlohmann::json value_of(const std::string& text) {
  if (const std::size_t comma = text.find(','); comma != std::string::npos) {
    nlohmann::json list = nlohmann::json::array();
    std::istringstream parts(text + ",");
    for (std::string part; std::getline(parts, part, ',');) list.push_back(value_of(part));
    return list;
  }
  if (text == "true" || text == "false") return text == "true";
  if (const auto whole = number_in<std::int64_t>(text)) return *whole;  // a double would round it
  if (const auto number = number_in<double>(text); number && std::isfinite(*number)) return *number;
  return text;
}

}  // namespace

std::span<const RenderOption> render_options() { return kOptions; }

RenderRequest read_render_options(const OptionValues& values) {
  nlohmann::json request = nlohmann::json::object();
  for (const auto& [name, text] : values) {
    const auto option = std::find_if(kOptions.begin(), kOptions.end(),
                                     [&wanted = name](const auto& o) { return o.name == wanted; });
    request[std::string(option->section)][std::string(option->key)] = value_of(text);
  }
  return read_request(document_of(std::move(request)));
}

InputError named_for(Naming naming, const InputError& error) {
  std::vector<Problem> problems = error.problems();
  for (Problem& problem : problems) {
    for (const RenderOption& option : kOptions) {
      const std::string own = "/" + std::string(option.section) + "/" + std::string(option.key);
      if (!(problem.pointer + "/").starts_with(own + "/")) continue;
      problem.pointer.replace(0, own.size(),
                              naming == Naming::query ? "/" + std::string(option.name)
                                                      : option.flags.substr(0, option.flags.find(',')));
      break;
    }
  }
  return InputError(std::move(problems));
}

}  // namespace orrery
