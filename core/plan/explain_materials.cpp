#include "core/plan/explain_materials.h"

#include "core/model/technique.h"
#include "core/textures/mapping.h"

namespace orrery {
namespace {

void explain_texture(const Scene& scene, std::size_t index, Plan& plan) {
  bool colours = false, bumps = false;
  for (const TextureUse& use : scene.texture_uses)
    if (use.texture == static_cast<int>(index)) (tilts(use) ? bumps : colours) = true;
  const PlacedTexture& texture = scene.textures[index];
  const std::string what = "texture " + texture.name;
  if (!colours && !bumps) {
    plan.decisions.push_back({what, "none", "no material uses it", {}});
    return;
  }
  plan.decisions.push_back({what,
                            texture.type,
                            std::string(name_of(texture.mapping.kind)) + " mapping, " +
                                (texture.filtered ? "averaged over the pixel" : "not filtered") +
                                (bumps ? colours ? "; values and bumps" : "; bumps" : ""),
                            {}});
}

}  // namespace

void explain_materials(const Scene& scene, Plan& plan) {
  for (std::size_t i = 0; i < scene.textures.size(); ++i) explain_texture(scene, i, plan);
  if (!scene.facts.cutouts) return;
  if (plan.technique->rasterizes)
    plan.decisions.push_back({"opacity", "ignored",
                              std::string(plan.technique->name) + " draws every surface; raycast does not",
                              Bound::unknown()});
  else
    plan.decisions.push_back({"opacity", "rays pass", "a material in use has an opacity below 1", {}});
}

}  // namespace orrery
