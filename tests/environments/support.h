#pragma once

#include <functional>

#include "core/load/load.h"
#include "core/model/asset_source.h"
#include "tests/support/tracing.h"

namespace orrery::test {

// Returns an image with the linear RGB value paint(x, y) in column x of row y.
inline Texels painted(int width, int height, const std::function<Vec3d(int x, int y)>& paint) {
  Texels picture{width, height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Vec3d value = paint(x, y);
      for (const double channel : {value.x, value.y, value.z})
        picture.rgb.push_back(static_cast<float>(channel));
    }
  return picture;
}

// Source that returns one image for every file.
class SingleImageSource final : public AssetSource {
 public:
  explicit SingleImageSource(Texels picture) : picture_(std::move(picture)) {}
  TexelsPtr picture_file(const std::string&) const override {
    return std::make_shared<const Texels>(picture_);
  }

 private:
  const Texels picture_;
};

// Returns a scene with a white floor that has the normal `normal`, in an environment with this image. `more`:
// further members of the environment.
inline std::shared_ptr<const Scene> surrounded(const Texels& picture, const Vec3d& normal,
                                               const Json& more = Json::object()) {
  Json scene = scene_of("[{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 1, 0]}]",
                        "{'materials': {'white': {'type': 'lambert', 'kd': null, 'reflectance': 1}}}");
  scene["objects"][0]["normal"] = numbers(normal);
  scene["environment"] = {{"type", "image"}, {"file", "sky.exr"}};
  scene["environment"].update(more);
  return load_scene(parse_document(scene.dump()), SingleImageSource(picture));
}

}  // namespace orrery::test
