#pragma once

#include <optional>
#include <string>

#include "server/import/mitsuba_xml.h"
#include "server/import/pbrt_parameters.h"
#include "server/import/scene_writer.h"
#include "server/import/values.h"

// Conversion of the parts of a Mitsuba scene. The names, defaults and units of properties are those of the
// documentation of Mitsuba 3 and 0.6 (mitsuba.readthedocs.io).
namespace orrery {

struct MitsubaScene {
  SceneWriter& scene;
  const MitsubaDocument& document;
  const SpectrumFiles& spectra;
  const ReadNearby& nearby;
  Affined mirror = {};  // from the description to the scene

  ImportNotes& notes() const { return scene.notes(); }
  // Map from an object to the scene. Models stay in the axes of the description.
  Affined map_of(const MitsubaObject& object) const {
    return scene.in_model() ? object.map() : compose(mirror, object.map());
  }
};

// Direction of v on a surface: Mitsuba's images have v = 0 at the top, those of scenes at the bottom.
enum class TextureSide { same_v, flipped_v };

// Return a property or texture of an object. Colours of emitters are radiance, where a spectrum of 1 is
// white.
Vec3d mitsuba_emission(MitsubaScene& mitsuba, const MitsubaObject& object, std::string_view name,
                       const Vec3d& fallback);
ImportValue mitsuba_color(MitsubaScene& mitsuba, const MitsubaObject& object, std::string_view name,
                          const ImportValue& fallback, TextureSide side);
ImportValue mitsuba_texture(MitsubaScene& mitsuba, const MitsubaObject& texture, TextureSide side);

// Returns a material, or nullopt for a surface that light passes.
std::optional<SceneJson> mitsuba_bsdf(MitsubaScene& mitsuba, const MitsubaObject& bsdf, TextureSide side,
                                      int depth = 0);

// Adds an emitter that is not a part of a shape.
void add_mitsuba_emitter(MitsubaScene& mitsuba, const MitsubaObject& emitter);
void add_mitsuba_shape(MitsubaScene& mitsuba, const MitsubaObject& shape);

}  // namespace orrery
