#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/meshes/text.h"
#include "core/params/params.h"
#include "server/import/pbrt_scene.h"
#include "server/import/view.h"

namespace orrery {
namespace {

constexpr int kMaxResolution = 1'000'000;

struct PbrtFilmSize {
  double width, height;
};
PbrtFilmSize film_size(const PbrtParameters& film) {
  return {static_cast<double>(film.integer("xresolution", 1280, 1, kMaxResolution)),
          static_cast<double>(film.integer("yresolution", 720, 1, kMaxResolution))};
}

// Returns half the height of the screen window, whose shorter side is from -1 to 1 by default (pbrt-v4,
// src/pbrt/cameras.cpp).
double half_screen_height(PbrtScene& pbrt, const PbrtView& view) {
  const PbrtParameters& p = view.camera_parameters;
  const auto [width, height] = film_size(view.film_parameters);
  const double frame = p.positive("frameaspectratio", width / height);
  std::array<double, 4> window{-frame, frame, -1, 1};
  if (frame < 1) window = {-1, 1, -1 / frame, 1 / frame};
  if (p.find("screenwindow") != nullptr) {
    const std::vector<double> given = p.numbers("screenwindow");
    if (given.size() != 4 || !(given[0] < given[1]) || !(given[2] < given[3]))
      refuse_at(p.place(), "screenwindow must have four numbers, x0 x1 y0 y1, with x0 < x1 and y0 < y1");
    std::copy(given.begin(), given.end(), window.begin());
  }
  const double across = window[1] - window[0], up = window[3] - window[2];
  if (std::abs(window[0] + window[1]) > 1e-6 * across || std::abs(window[2] + window[3]) > 1e-6 * up)
    pbrt.notes().add("view that is off the centre (screenwindow) is centred");
  if (std::abs(across / up - width / height) > 1e-3 * (width / height))
    pbrt.notes().add("pixels that are not square become square");
  return up / 2;
}

ImportCamera camera_of(const PbrtView& view) {
  ImportCamera camera{.map = view.map, .right = {1, 0, 0}, .up = {0, 1, 0}, .forward = {0, 0, 1}};
  if (view.camera == "spherical") {  // the first column of the image looks along +x and turns toward +z
    camera.right = {0, 0, -1};
    camera.forward = {-1, 0, 0};
  }
  camera.target_distance = view.target_distance / std::max(length(view.map.z), 1e-12);
  return camera;
}

}  // namespace

bool is_mirrored(const PbrtView& view) { return sees_mirrored(camera_of(view)); }

double pbrt_exposure(PbrtScene& pbrt, const PbrtView& view) {
  const PbrtParameters& film = view.film_parameters;
  if (film.text("sensor", "cie1931") != "cie1931")
    pbrt.notes().add("sensor " + excerpt(film.text("sensor", "")) + " is replaced by cie1931");
  const double open = view.camera_parameters.number("shutteropen", 0);
  const double closed = view.camera_parameters.number("shutterclose", 1);
  const double exposure = (closed - open) * film.number("iso", 100) / 100;
  if (!(exposure > 0 && exposure <= 1e12))
    refuse_at(film.place(),
              "exposure, (shutterclose - shutteropen) iso / 100, must be above 0 and at most 1e12 (got " +
                  number_text(exposure) + ")");
  return exposure;
}

void set_pbrt_view(PbrtScene& pbrt, const PbrtView& view) {
  const PbrtParameters& p = view.camera_parameters;
  pbrt.scene.at(p.place());
  ImportCamera camera = camera_of(view);
  const double half = half_screen_height(pbrt, view);
  p.ignore({"shutteropen", "shutterclose"});
  if (view.camera == "spherical") {
    camera.type = "panorama";
    if (p.text("mapping", "equalarea") != "equirectangular")
      pbrt.notes().add("equal-area image of all directions becomes equirectangular");
  } else if (view.camera == "orthographic") {
    camera.type = "orthographic";
    camera.half_height = half;
  } else {
    const double fov = p.number("fov", 90);
    if (!(fov > 0 && fov < 180))
      refuse_at(p.place(), "fov must be above 0 and below 180 degrees (got " + number_text(fov) + ")");
    camera.half_height = half * std::tan(fov / 2 * std::numbers::pi / 180);
    if (view.camera == "realistic")
      pbrt.notes().add("realistic camera is replaced by a perspective one");
    else if (view.camera != "perspective")
      refuse_at(p.place(),
                "type of a camera must be perspective, orthographic, spherical or realistic (got " +
                    excerpt(view.camera) + ")");
  }
  camera.lens_radius = p.number("lensradius", 0);
  camera.focus_distance = p.positive("focaldistance", 1e6);
  set_camera(pbrt.scene, camera);
  p.note_unused(pbrt.notes(), "camera " + excerpt(view.camera));

  const PbrtParameters& film = view.film_parameters;
  const auto [width, height] = film_size(film);
  set_image_size(pbrt.scene, width, height);
  if (film.find("cropwindow") != nullptr || film.find("pixelbounds") != nullptr)
    pbrt.notes().add("crop of the image is left out");
  film.ignore({"filename", "diagonal", "savefp16", "maxcomponentvalue", "iso", "sensor", "whitebalance"});
  film.note_unused(pbrt.notes(), "film");
}

void set_pbrt_sampling(PbrtScene& pbrt, const PbrtParameters& sampler, const PbrtParameters& integrator,
                       const std::string& filter) {
  set_render_options(pbrt.scene, sampler.number("pixelsamples", 16), integrator.number("maxdepth", 5),
                     filter == "sinc" ? "lanczos" : filter);
}

}  // namespace orrery
