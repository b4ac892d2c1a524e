#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "server/import/pbrt_parameters.h"
#include "server/import/scene_writer.h"
#include "server/import/values.h"

// Conversion of the parts of a pbrt-v4 scene. The names, defaults and units of parameters are those of the
// pbrt-v4 file format (pbrt.org/fileformat-v4).
namespace orrery {

// Material that shapes refer to. Converted when a shape uses it.
struct PbrtMaterial {
  std::string name;  // name of a named material, otherwise the type
  std::string type;
  PbrtParameters parameters;
  bool is_converted = false;
  std::optional<SceneJson> json = {};  // none: no surface
};

struct PbrtScene {
  SceneWriter& scene;
  const SpectrumFiles& spectra;
  const ReadNearby& nearby;
  std::map<std::string, ImportValue> colors = {}, numbers = {};  // textures by name
  std::map<std::string, std::shared_ptr<PbrtMaterial>> materials = {};
  double exposure = 1;  // factor of all light

  ImportNotes& notes() const { return scene.notes(); }
};

// Shape with its attributes.
struct PbrtShape {
  std::string type;
  const PbrtParameters& parameters;
  Affined map;
  bool reversed;
  PbrtMaterial& material;
  const PbrtParameters* area_light;  // or null
};

// Return a parameter that may be a texture.
ImportValue pbrt_color(const PbrtScene& pbrt, const PbrtParameters& parameters, std::string_view name,
                       const ImportValue& fallback);
ImportValue pbrt_number(const PbrtScene& pbrt, const PbrtParameters& parameters, std::string_view name,
                        double fallback);

// Returns the texture of a directive `Texture`. `is_color`: a texture of spectra, otherwise of numbers.
ImportValue pbrt_texture(PbrtScene& pbrt, const std::string& name, bool is_color, const std::string& type,
                         const PbrtParameters& parameters);
// Returns the name of a texture of the scene for an image file. `encoding`: srgb or linear.
std::string pbrt_image(PbrtScene& pbrt, const std::string& file, const std::string& encoding,
                       const PbrtParameters& parameters);

// Returns a material without emission and opacity, or nullopt for a boundary of media without a surface.
std::optional<SceneJson> pbrt_material(PbrtScene& pbrt, const std::string& type,
                                       const PbrtParameters& parameters);

void add_pbrt_light(PbrtScene& pbrt, const std::string& type, const PbrtParameters& parameters,
                    const Affined& map);
// Returns the radiance of an area light, as a colour or with a texture. A light that states its power has it
// on each surface of `area`.
SceneJson pbrt_emission(PbrtScene& pbrt, const PbrtParameters& light, double area);

void add_pbrt_shape(PbrtScene& pbrt, const PbrtShape& shape);

// Camera and film, which become the keys "camera" and "image".
struct PbrtView {
  std::string camera = "perspective";
  PbrtParameters camera_parameters = {}, film_parameters = {};
  Affined map = {};            // from camera space to the scene
  double target_distance = 1;  // from the last LookAt, in the scene
};
// Returns whether the scene has to be mirrored: cameras of orrery are right-handed.
bool is_mirrored(const PbrtView& view);
// Returns the factor of all light: exposure time times ISO / 100.
double pbrt_exposure(PbrtScene& pbrt, const PbrtView& view);
void set_pbrt_view(PbrtScene& pbrt, const PbrtView& view);
void set_pbrt_sampling(PbrtScene& pbrt, const PbrtParameters& sampler, const PbrtParameters& integrator,
                       const std::string& filter);

}  // namespace orrery
