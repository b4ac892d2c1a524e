#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/meshes/text.h"
#include "core/params/params.h"
#include "server/import/environment.h"
#include "server/import/mitsuba_scene.h"

// Emitters of Mitsuba have radiometric units: radiance, W/sr of point and spot lights, irradiance of
// directional lights. Irradiance E makes a white surface as bright as E / pi, so the intensity of point, spot
// and directional lights of scenes is that of Mitsuba divided by pi.
namespace orrery {
namespace {

SceneJson intensity_json(MitsubaScene& mitsuba, const MitsubaObject& emitter, const char* name) {
  return mitsuba.scene.color(mitsuba_emission(mitsuba, emitter, name, Vec3d(1)) *
                             (emitter.number("scale", 1) / std::numbers::pi));
}

SceneJson positional(MitsubaScene& mitsuba, const MitsubaObject& emitter, const char* type) {
  const Vec3d at = emitter.point("position", {});
  return {{"type", type},
          {"position", mitsuba.scene.point(mitsuba.map_of(emitter).point(at))},
          {"intensity", intensity_json(mitsuba, emitter, "intensity")},
          {"attenuation", {0, 0, 1}},
          {"clamp_to_one", false}};
}

SceneJson spot(MitsubaScene& mitsuba, const MitsubaObject& emitter) {
  SceneJson light = positional(mitsuba, emitter, "spot");
  const double outer = emitter.number("cutoff_angle", 20), inner = emitter.number("beam_width", outer * 0.75);
  if (!(outer > 0 && outer <= 180 && inner >= 0 && inner <= outer))
    refuse_at(emitter.place,
              "cutoff_angle must be above 0 and at most 180 degrees, and beam_width at most that (got " +
                  number_text(outer) + " and " + number_text(inner) + ")");
  light["direction"] = mitsuba.scene.direction(mitsuba.map_of(emitter).z);
  light["inner_degrees"] = inner;
  light["outer_degrees"] = outer;
  return light;
}

SceneJson directional(MitsubaScene& mitsuba, const MitsubaObject& emitter) {
  const Affined map = mitsuba.map_of(emitter);
  const Vec3d along =
      emitter.find("direction") != nullptr ? map.vector(emitter.point("direction", {})) : map.z;
  if (safe_normalize(along) == Vec3d(0, 0, 0))
    refuse_at(emitter.place, "direction must not be 0 (got 0, 0, 0)");
  return {{"type", "directional"},
          {"direction_to_light", mitsuba.scene.direction(-along)},
          {"intensity", intensity_json(mitsuba, emitter, "irradiance")}};
}

}  // namespace

void add_mitsuba_emitter(MitsubaScene& mitsuba, const MitsubaObject& emitter) {
  mitsuba.scene.at(emitter.place);
  emitter.ignore({"sampling_weight"});
  const std::string& type = emitter.type;
  if (type == "point") {
    mitsuba.scene.add_light(positional(mitsuba, emitter, "point"));
  } else if (type == "spot") {
    mitsuba.scene.add_light(spot(mitsuba, emitter));
  } else if (type == "directional") {
    mitsuba.scene.add_light(directional(mitsuba, emitter));
  } else if (type == "constant") {
    add_constant_environment(
        mitsuba.scene, mitsuba_emission(mitsuba, emitter, "radiance", Vec3d(1)) * emitter.number("scale", 1));
  } else if (type == "envmap") {
    add_image_environment(mitsuba.scene, mitsuba.nearby, emitter.text("filename", ""),
                          EnvironmentLayout::mitsuba, mitsuba.map_of(emitter),
                          Vec3d(emitter.number("scale", 1)));
  } else if (type == "sky" || type == "sunsky" || type == "sun") {
    mitsuba.notes().add("emitter " + excerpt(type) + " is replaced by a sky gradient");
    if (mitsuba.scene.find("environment") == nullptr)
      mitsuba.scene.set("environment", {{"type", "gradient"}});
    return;
  } else {
    mitsuba.notes().add("emitter " + excerpt(type) + " is left out");
    return;
  }
  emitter.note_unused(mitsuba.notes());
}

}  // namespace orrery
