#include "core/materials/surface_params.h"

#include "core/materials/material_params.h"

namespace orrery {
namespace {

// Reads the texture at `key` that stands for a value. Returns nullptr if the value is no texture.
const TextureUse* read_texture(Params& p, const TextureNames& textures, const char* key, int slot,
                               bool is_color, double max, std::vector<TextureUse>& uses) {
  const bool is_textured =
      p.object_instead(key, "texture_use", "A texture instead of a value.", [&](Params& t) {
        TextureUse use = read_texture_use(t, textures, is_color);
        use.slot = slot;
        const double least = std::min({use.least.x, use.least.y, use.least.z}),
                     most = max_component(use.most);
        if (static_cast<std::size_t>(use.texture) < textures.bounds.size() && !(least >= 0 && most <= max))
          t.fail("", "values must be from 0 to " + number_text(max) + " (got " + number_text(least) + " to " +
                         number_text(most) + ")");
        uses.push_back(use);
      });
  return is_textured && !uses.empty() ? &uses.back() : nullptr;
}

void read_bump(Params& p, const TextureNames& textures, std::vector<TextureUse>& uses) {
  p.object_if_given(
      "bump", "Height of the surface, which tilts the shading normal. It moves no point.", [&](Params& bump) {
        TextureUse use;
        use.texture = static_cast<int>(bump.reference("texture", "Name of the texture.", textures.names));
        use.slot = kBumpSlot;
        use.channel = TextureChannel::luminance;
        use.scale = Vec3d(bump.number("scale", "Height in metres where the luminance is 1.",
                                      {.min = -kMaxLength, .max = kMaxLength}));
        uses.push_back(use);
      });
}

void read_normal_map(Params& p, const TextureNames& textures, std::vector<TextureUse>& uses) {
  constexpr double kMaxScale = 1e5;
  p.object_if_given("normal_map", "Shading normals 2 c - 1 of colours c: x along u, y along v, z outward.",
                    [&](Params& map) {
                      TextureUse use;
                      use.texture =
                          static_cast<int>(map.reference("texture", "Name of the texture.", textures.names));
                      use.slot = kNormalSlot;
                      use.channel = TextureChannel::rgb;
                      const double scale = map.number("scale", "Factor of x and y.",
                                                      {.min = -kMaxScale, .max = kMaxScale}, 1.0);
                      use.scale = {2 * scale, 2 * scale, 2};
                      use.offset = {-scale, -scale, -1};
                      uses.push_back(use);
                    });
}

}  // namespace

SurfaceParams read_surface_params(Params& p, const TextureNames& textures) {
  SurfaceParams read;
  if (const auto* const use =
          read_texture(p, textures, "emission", kEmissionSlot, true, kMaxColor, read.uses))
    read.emission = use->most;
  else
    read.emission = p.color("emission", "Radiance that surfaces emit on both sides, per channel.", Vec3d(0));
  if (const auto* const use = read_texture(p, textures, "opacity", kOpacitySlot, false, 1, read.uses))
    read.opacity = use->least.x;
  else
    read.opacity =
        p.number("opacity", "Share of the rays that meet the surface; the others pass straight on.",
                 {.min = 0, .max = 1}, 1.0);
  const double cutoff = p.number("alpha_cutoff",
                                 "Opacity below which all rays pass, and above which none passes; default: "
                                 "rays pass at random.",
                                 {.min = 0}, derived(0.0));
  if (p.has("alpha_cutoff")) read.alpha_cutoff = cutoff;
  read_bump(p, textures, read.uses);
  read_normal_map(p, textures, read.uses);
  return read;
}

}  // namespace orrery
