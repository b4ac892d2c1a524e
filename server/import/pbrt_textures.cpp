#include <algorithm>
#include <array>

#include "core/meshes/text.h"
#include "server/import/pbrt_scene.h"

namespace orrery {
namespace {

// Adds the mapping from texture coordinates of surfaces, unless it changes nothing.
void add_pbrt_mapping(PbrtScene& pbrt, SceneJson& texture, const PbrtParameters& p) {
  const std::string mapping = p.text("mapping", "uv");
  if (mapping != "uv") pbrt.notes().add("texture mapping " + excerpt(mapping) + " is replaced by uv");
  const double su = p.number("uscale", 1), sv = p.number("vscale", 1);
  const double du = p.number("udelta", 0), dv = p.number("vdelta", 0);
  if (su == 1 && sv == 1 && du == 0 && dv == 0) return;
  texture["mapping"] = {{"type", "uv"}, {"repeat_u", su}, {"repeat_v", sv}, {"shift_u", du}, {"shift_v", dv}};
}

ImportValue image_value(PbrtScene& pbrt, const PbrtParameters& p) {
  std::string encoding = p.text("encoding", "sRGB");
  if (encoding != "sRGB" && encoding != "linear")
    pbrt.notes().add("image encoding " + excerpt(encoding) + " is replaced by sRGB");
  p.ignore({"filter", "maxanisotropy"});
  const std::string file = p.text("filename", "");
  if (file.empty()) refuse_at(p.place(), "texture imagemap must have a filename (got none)");
  ImportValue value;
  value.texture = pbrt_image(pbrt, file, encoding == "linear" ? "linear" : "srgb", p);
  value.factor = Vec3d(value.is_constant() ? 0.5 : p.number("scale", 1));
  value.inverted = p.flag("invert", false);
  return value;
}

ImportValue read_pbrt_operand(const PbrtScene& pbrt, const PbrtParameters& p, bool is_color,
                              std::string_view name, double fallback) {
  return is_color ? pbrt_color(pbrt, p, name, grey(fallback)) : pbrt_number(pbrt, p, name, fallback);
}

ImportValue checkerboard(PbrtScene& pbrt, const std::string& name, const PbrtParameters& p, bool is_color) {
  const ImportValue even = read_pbrt_operand(pbrt, p, is_color, "tex1", 1);
  const ImportValue odd = read_pbrt_operand(pbrt, p, is_color, "tex2", 0);
  if (!even.is_constant() || !odd.is_constant())
    pbrt.notes().add("checkerboard of textures is replaced by one of their means");
  if (p.integer("dimension", 2, 2, 3) == 3)
    pbrt.notes().add("three-dimensional checkerboard is replaced by a flat one");
  SceneJson texture{
      {"type", "checker"}, {"even", pbrt.scene.color(even.mean())}, {"odd", pbrt.scene.color(odd.mean())}};
  add_pbrt_mapping(pbrt, texture, p);
  ImportValue value;
  value.texture = pbrt.scene.texture(name, std::move(texture));
  if (value.is_constant()) value.factor = (even.mean() + odd.mean()) / 2;
  return value;
}

ImportValue scaled_texture(PbrtScene& pbrt, const PbrtParameters& p, bool is_color) {
  ImportValue tex = read_pbrt_operand(pbrt, p, is_color, "tex", 1);
  ImportValue scale = pbrt_number(pbrt, p, "scale", 1);
  if (!tex.is_constant() && !scale.is_constant()) {
    pbrt.notes().add("product of textures is replaced by the first one");
    return tex;
  }
  if (tex.is_constant()) std::swap(tex, scale);
  if (tex.inverted) pbrt.notes().add("scale of an inverted texture is left out");
  if (!tex.inverted) tex.factor = tex.factor * scale.mean();
  return tex;
}

ImportValue mixed_texture(PbrtScene& pbrt, const PbrtParameters& p, bool is_color) {
  const ImportValue first = read_pbrt_operand(pbrt, p, is_color, "tex1", 0);
  const ImportValue second = read_pbrt_operand(pbrt, p, is_color, "tex2", 1);
  const double amount = pbrt_number(pbrt, p, "amount", 0.5).mean().x;
  if (first.is_constant() && second.is_constant() && p.texture("amount").empty())
    return {first.mean() * (1 - amount) + second.mean() * amount};
  pbrt.notes().add("mix of textures is replaced by the larger share");
  return amount > 0.5 ? second : first;
}

ImportValue find_texture(const std::map<std::string, ImportValue>& textures, const std::string& name,
                         const ImportPlace& place) {
  const auto found = textures.find(name);
  if (found == textures.end())
    refuse_at(place, "texture must be defined before it is used (got " + excerpt(name) + ")");
  return found->second;
}

}  // namespace

std::string pbrt_image(PbrtScene& pbrt, const std::string& file, const std::string& encoding,
                       const PbrtParameters& p) {
  const std::string wrap = p.text("wrap", "repeat");
  if (wrap == "black" || wrap == "octahedralsphere")
    pbrt.notes().add("wrap mode " + excerpt(wrap) + " is replaced by clamp");
  else if (wrap != "repeat" && wrap != "clamp")
    refuse_at(p.place(), "wrap must be repeat, black, clamp or octahedralsphere (got " + excerpt(wrap) + ")");
  SceneJson texture{{"type", "image"},
                    {"file", pbrt.scene.file_name(file)},
                    {"encoding", encoding},
                    {"wrap", wrap == "repeat" ? "repeat" : "clamp"}};
  add_pbrt_mapping(pbrt, texture, p);
  return pbrt.scene.texture(file, std::move(texture));
}

ImportValue pbrt_color(const PbrtScene& pbrt, const PbrtParameters& p, std::string_view name,
                       const ImportValue& fallback) {
  const std::string texture = p.texture(name);
  if (!texture.empty()) return find_texture(pbrt.colors, texture, p.place());
  const auto color = p.surface_color(name, pbrt.spectra);
  return color ? ImportValue{*color} : fallback;
}

ImportValue pbrt_number(const PbrtScene& pbrt, const PbrtParameters& p, std::string_view name,
                        double fallback) {
  const std::string texture = p.texture(name);
  if (!texture.empty()) return find_texture(pbrt.numbers, texture, p.place());
  return grey(p.number(name, fallback));
}

ImportValue pbrt_texture(PbrtScene& pbrt, const std::string& name, bool is_color, const std::string& type,
                         const PbrtParameters& p) {
  pbrt.scene.at(p.place());
  if (type == "imagemap") return image_value(pbrt, p);
  if (type == "constant") return read_pbrt_operand(pbrt, p, is_color, "value", 1);
  if (type == "scale") return scaled_texture(pbrt, p, is_color);
  if (type == "mix") return mixed_texture(pbrt, p, is_color);
  if (type == "checkerboard") return checkerboard(pbrt, name, p, is_color);
  constexpr std::array<std::string_view, 8> kOthers{"bilerp",   "directionmix", "dots",   "fbm",
                                                    "wrinkled", "windy",        "marble", "ptex"};
  if (std::find(kOthers.begin(), kOthers.end(), type) == kOthers.end())
    refuse_at(p.place(),
              "type of a texture must be one of pbrt's, such as imagemap (got " + excerpt(type) + ")");
  pbrt.notes().add("texture of type " + excerpt(type) + " is replaced by grey");
  return grey(0.5);
}

}  // namespace orrery
