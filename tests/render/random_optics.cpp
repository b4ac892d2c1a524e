#include "tests/render/random_optics.h"

#include <cstdlib>

namespace orrery::test {
namespace {

Json color(Random& random, double most) {
  return numbers({random.between(0, most), random.between(0, most), random.between(0, most)});
}

Json matt(Random& random) {
  switch (random.below(4)) {
    case 0: return {{"type", "lambert"}, {"reflectance", color(random, 1)}};
    case 1:
      return {{"type", "oren-nayar"}, {"reflectance", color(random, 1)}, {"roughness", random.between(0, 1)}};
    default:
      return {{"type", "rough"},
              {"kd", random.between(0, 1)},
              {"ka", random.between(0, 1)},
              {"ks", random.between(0, 1)},
              {"cd", color(random, 1)},
              {"shininess", random.magnitude(1, 200)},
              {"shading", random.below(2) == 0 ? "phong" : "blinn-phong"}};
  }
}

// Returns a specular material. Plastic is used only without ambient light.
Json specular(Random& random, bool ambient) {
  switch (random.below(ambient ? 3 : 4)) {
    case 0:
      return {{"type", "reflective"},
              {"n", color(random, 3)},
              {"k", color(random, 5)},
              {"fresnel", random.below(2) == 0 ? "exact" : "schlick"}};
    case 3: return {{"type", "plastic"}, {"reflectance", color(random, 1)}, {"roughness", 0}};
    default:
      return {{"type", "refractive"},
              {"ior", random.between(1.05, 2.2)},
              {"filter", numbers({random.between(0.2, 1), random.between(0.2, 1), random.between(0.2, 1)})},
              {"fresnel", random.below(2) == 0 ? "exact" : "schlick"}};
  }
}

Json shape(Random& random) {
  const Vec3d at = random.in_cube(1.5);
  const double size = random.between(0.25, 0.9);
  switch (random.below(4)) {
    case 0: return {{"type", "box"}, {"min", numbers(at - Vec3d(size))}, {"max", numbers(at + Vec3d(size))}};
    case 1:
      return {{"type", "cylinder"},
              {"base", numbers(at)},
              {"top", numbers(at + random.direction() * size)},
              {"radius", 0.6 * size}};
    default: return {{"type", "sphere"}, {"center", numbers(at)}, {"radius", size}};
  }
}

// Returns a light of random intensity, `share` on average. A white surface that faces all lights then has a
// radiance of about 1 if the sum of their `share` is 1.
Json light(Random& random, double share) {
  const Json intensity = color(random, 2 * share);
  if (random.below(3) == 0)
    return {{"type", "directional"},
            {"direction_to_light", numbers(random.direction_above({0, 1, 0}))},
            {"intensity", intensity}};
  const Vec3d place = random.direction_above({0, 1, 0}) * random.between(1, 6);
  Json found = {{"type", "point"},
                {"position", numbers(place)},
                {"intensity", intensity},
                {"attenuation", {random.between(0.2, 1), random.between(0, 0.3), random.between(0, 0.2)}}};
  if (random.below(3) == 0) {
    found["type"] = "spot";
    found["direction"] = numbers(place * -1.0);
    found["outer_degrees"] = 40;
  }
  return found;
}

}  // namespace

Random scenes_seed() {
  const char* const asked = std::getenv("SCENES_SEED");
  return Random(asked ? std::strtoull(asked, nullptr, 10) : 1);
}

Json random_optics(Random& random) {
  Json materials = Json::object(), objects = Json::array(), lights = Json::array();
  const bool ambient = random.below(2) == 0;
  const int count = 3 + random.below(6);
  for (int i = 0; i < count; ++i) {
    const std::string name = "m" + std::to_string(i);
    const bool is_matt = random.below(3) == 0;
    materials[name] = is_matt ? matt(random) : specular(random, ambient);
    if (is_matt && random.below(3) == 0) materials[name]["emission"] = color(random, 1);
    Json object = shape(random);
    object["material"] = name;
    objects.push_back(std::move(object));
  }
  materials["floor"] = matt(random);
  if (random.below(3) > 0)
    objects.push_back(
        {{"type", "plane"}, {"point", {0, -2.5, 0}}, {"normal", {0, 1, 0}}, {"material", "floor"}});
  else
    objects.push_back({{"type", "box"}, {"min", {-4, -3, -4}}, {"max", {4, -2.5, 4}}, {"material", "floor"}});
  const int sources = 1 + random.below(4);
  for (int i = 0; i < sources; ++i) lights.push_back(light(random, 1.0 / sources));
  Json patch = {{"materials", std::move(materials)},
                {"lights", std::move(lights)},
                {"camera",
                 {{"type", "perspective"},
                  {"eye", numbers(random.direction() * random.between(0.5, 6))},
                  {"look_at", numbers(random.in_cube(0.5))},
                  {"fov_degrees", 60}}}};
  if (ambient) patch["ambient"] = color(random, 0.6);
  if (random.below(3) == 0)
    patch["environment"] = {
        {"type", "gradient"}, {"zenith", color(random, 1)}, {"horizon", color(random, 1)}};
  else
    patch["background"] = color(random, 1);
  return scene_with(objects, patch);
}

}  // namespace orrery::test
