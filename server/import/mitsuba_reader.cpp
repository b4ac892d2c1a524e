#include "server/import/mitsuba_reader.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/shorten.h"
#include "core/meshes/text.h"
#include "core/params/params.h"
#include "server/import/mitsuba_scene.h"
#include "server/import/view.h"

namespace orrery {
namespace {

class MitsubaReader {
 public:
  MitsubaReader(const std::string& text, const std::string& name, const ReadNearby& nearby,
                const ImportOptions& options)
      : name_(name),
        writer_(options),
        document_(text, name, nearby, options.limits),
        spectra_(nearby),
        mitsuba_{writer_, document_, spectra_, nearby} {}

  ImportedScene read() {
    const MitsubaObject& scene = document_.scene();
    writer_.at(scene.place);
    if (scene.tag != "scene")
      refuse_at(scene.place, "root of the document must be a scene (got " + excerpt(scene.tag) + ")");
    writer_.set("title", shortened(as_utf8(name_), 100));
    const std::vector<const MitsubaObject*> sensors = document_.children(scene, "sensor");
    if (sensors.empty()) refuse_at(scene.place, "scene must have a sensor (got none)");
    for (std::size_t i = 1; i < sensors.size(); ++i) mitsuba_.notes().add("second sensor is left out");
    read_sensor(*sensors.front());
    for (const MitsubaObject* const shape : document_.children(scene, "shape"))
      add_mitsuba_shape(mitsuba_, *shape);
    for (const MitsubaObject* const emitter : document_.children(scene, "emitter"))
      add_mitsuba_emitter(mitsuba_, *emitter);
    if (!document_.children(scene, "medium").empty()) mitsuba_.notes().add("medium is left out");
    writer_.at(scene.place);
    return writer_.finish();
  }

 private:
  struct FilmSize {
    double width, height;
  };

  FilmSize film_size(const MitsubaObject& sensor) {
    const MitsubaObject* const film = document_.child(sensor, "film");
    if (film == nullptr) return {768, 576};
    const auto side = [&](const char* name, double fallback) {
      const double pixels = film->number(name, fallback);
      if (!(pixels >= 1 && pixels <= 1e6 && pixels == std::floor(pixels)))
        refuse_at(film->place, std::string(name) + " must be an integer from 1 to 1,000,000 (got " +
                                   number_text(pixels) + ")");
      return pixels;
    };
    if (film->find("crop_width") != nullptr || film->find("crop_height") != nullptr)
      mitsuba_.notes().add("crop of the image is left out");
    return {side("width", 768), side("height", 576)};
  }

  // Returns half the height of the view at distance 1 (Mitsuba 3, plugin "perspective").
  double half_height(const MitsubaObject& sensor, double aspect) {
    double fov = sensor.number("fov", 45);
    std::string axis = sensor.text("fov_axis", "x");
    if (const MitsubaProperty* const focal = sensor.find("focal_length");
        focal != nullptr && sensor.find("fov") == nullptr) {
      std::string millimetres = focal->text;
      if (millimetres.ends_with("mm")) millimetres.resize(millimetres.size() - 2);
      const std::vector<double> n = numbers_of(millimetres, focal->place);
      if (n.size() != 1 || !(n[0] > 0))
        refuse_at(focal->place, "focal_length must be above 0 mm (got " + excerpt(focal->text) + ")");
      fov = 2 * std::atan(std::sqrt(36.0 * 36 + 24 * 24) / 2 / n[0]) * 180 / std::numbers::pi;
      axis = "diagonal";
    }
    if (!(fov > 0 && fov < 180))
      refuse_at(sensor.place, "fov must be above 0 and below 180 degrees (got " + number_text(fov) + ")");
    if (axis == "smaller") axis = aspect > 1 ? "y" : "x";
    if (axis == "larger") axis = aspect > 1 ? "x" : "y";
    const double half = std::tan(fov / 2 * std::numbers::pi / 180);
    if (axis == "x") return half / aspect;
    if (axis == "y") return half;
    if (axis == "diagonal") return half / std::sqrt(1 + aspect * aspect);
    refuse_at(sensor.place, "fov_axis must be x, y, diagonal, smaller or larger (got " + excerpt(axis) + ")");
  }

  void read_sensor(const MitsubaObject& sensor) {
    writer_.at(sensor.place);
    sensor.ignore({"near_clip", "far_clip", "shutter_open", "shutter_close"});
    const auto [width, height] = film_size(sensor);
    ImportCamera camera{.map = sensor.map(), .right = {-1, 0, 0}, .up = {0, 1, 0}, .forward = {0, 0, 1}};
    if (sensor.type == "orthographic") {
      camera.type = "orthographic";
      camera.half_height = height / width;
    } else {
      camera.half_height = half_height(sensor, width / height);
      if (sensor.type == "thinlens") {
        camera.lens_radius = sensor.number("aperture_radius", 0);
        camera.focus_distance = sensor.positive("focus_distance", 1);
      } else if (sensor.type != "perspective") {
        mitsuba_.notes().add("sensor " + excerpt(sensor.type) + " is replaced by a perspective one");
      }
      sensor.ignore({"focus_distance"});
    }
    if (sensor.find("principal_point_offset_x") != nullptr ||
        sensor.find("principal_point_offset_y") != nullptr)
      mitsuba_.notes().add("view that is off the centre is centred");
    if (sees_mirrored(camera)) mitsuba_.mirror = scaling({1, 1, -1});
    camera.map = compose(mitsuba_.mirror, camera.map);
    set_camera(writer_, camera);
    set_image_size(writer_, width, height);
    sensor.note_unused(mitsuba_.notes());
    read_sampling(sensor);
  }

  void read_sampling(const MitsubaObject& sensor) {
    const MitsubaObject* const sampler = document_.child(sensor, "sampler");
    const MitsubaObject* const integrator = document_.child(document_.scene(), "integrator");
    const MitsubaObject* const film = document_.child(sensor, "film");
    const MitsubaObject* const filter = film == nullptr ? nullptr : document_.child(*film, "rfilter");
    const double depth = integrator == nullptr ? -1 : integrator->number("max_depth", -1);
    set_render_options(writer_, sampler == nullptr ? 4 : sampler->number("sample_count", 4),
                       depth < 0 ? 1e9 : depth - 1, filter == nullptr ? "gaussian" : filter->type);
  }

  const std::string& name_;
  SceneWriter writer_;
  MitsubaDocument document_;
  SpectrumFiles spectra_;
  MitsubaScene mitsuba_;
};

}  // namespace

ImportedScene import_mitsuba(const std::string& text, const std::string& name, const ReadNearby& nearby,
                             const ImportOptions& options) {
  return MitsubaReader(text, name, nearby, options).read();
}

}  // namespace orrery
