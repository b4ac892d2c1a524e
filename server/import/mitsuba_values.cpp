#include <algorithm>
#include <cmath>

#include "core/base/number.h"
#include "core/math/decode_srgb.h"
#include "core/meshes/text.h"
#include "core/params/params.h"
#include "server/import/mitsuba_scene.h"
#include "server/import/spectrum.h"

namespace orrery {
namespace {

double decoded(double code) { return decode_srgb(static_cast<float>(std::clamp(code, 0.0, 1.0))); }

// Returns the colour of #rrggbb, or nullopt for other texts.
std::optional<Vec3d> hexadecimal(const std::string& text) {
  if (text.size() != 7 || text[0] != '#') return std::nullopt;
  Vec3d rgb;
  for (std::size_t i = 0; i < 3; ++i) {
    int code = 0;
    const char* const from = text.data() + 1 + 2 * i;
    const auto [end, problem] = std::from_chars(from, from + 2, code, 16);
    if (problem != std::errc() || end != from + 2) return std::nullopt;
    rgb[i] = decoded(code / 255.0);
  }
  return rgb;
}

// Returns the spectrum of "400:0.1, 500:0.3", or nullopt for other texts.
std::optional<SpectrumTable> table_of_text(const std::string& text, const ImportPlace& place) {
  if (text.find(':') == text.npos) return std::nullopt;
  std::string plain = text;
  std::replace(plain.begin(), plain.end(), ':', ' ');
  const std::vector<double> n = numbers_of(plain, place);
  SpectrumTable table;
  for (std::size_t i = 0; i + 1 < n.size(); i += 2) {
    if (i > 0 && n[i] <= n[i - 2])
      refuse_at(place, "wavelengths must be in ascending order (got " + number_text(n[i]) + ")");
    table.points.emplace_back(n[i], n[i + 1]);
  }
  if (table.points.empty() || n.size() % 2 != 0)
    refuse_at(place, "spectrum must have a value for each wavelength (got " + excerpt(text) + ")");
  return table;
}

Vec3d blackbody_rgb(double kelvin, double scale, const ImportPlace& place) {
  if (!(kelvin >= 100 && kelvin <= 1e6))
    refuse_at(place, "temperature of a black body must be a number from 100 to 1,000,000 K (got " +
                         number_text(kelvin) + ")");
  return emitted_rgb_of_blackbody(kelvin) * scale;
}

Vec3d color_of_table(const SpectrumTable& table, bool emits) {
  return emits ? emitted_rgb(table) : reflected_rgb(table);
}

Vec3d property_color(const MitsubaScene& mitsuba, const MitsubaProperty& p, bool emits) {
  if (p.tag == "blackbody") {
    std::string kelvin = p.text;
    if (kelvin.ends_with('K') || kelvin.ends_with('k')) kelvin.pop_back();
    const std::vector<double> n = numbers_of(kelvin, p.place);
    return blackbody_rgb(n.empty() ? 0 : n[0], p.scale, p.place);
  }
  if (p.tag == "spectrum file") return color_of_table(mitsuba.spectra.read(p.text, p.place), emits);
  if (const auto rgb = hexadecimal(p.text)) return *rgb;
  if (const auto table = table_of_text(p.text, p.place)) return color_of_table(*table, emits);
  const std::vector<double> n = numbers_of(p.text, p.place);
  if (n.size() != 1 && n.size() != 3)
    refuse_at(p.place, "colour must have one or three numbers (got " + excerpt(p.text) + ")");
  const Vec3d color = n.size() == 1 ? Vec3d(n[0]) : Vec3d(n[0], n[1], n[2]);
  return p.tag == "srgb" ? Vec3d(decoded(color.x), decoded(color.y), decoded(color.z)) : color;
}

// Returns the colour of an object <spectrum type="...">.
Vec3d object_color(MitsubaScene& mitsuba, const MitsubaObject& spectrum, bool emits) {
  const std::string& type = spectrum.type;
  if (type == "blackbody")
    return blackbody_rgb(spectrum.number("temperature", 0), spectrum.number("scale", 1), spectrum.place);
  if (type == "d65") return Vec3d(spectrum.number("scale", 1));
  if (type == "uniform") return Vec3d(spectrum.number("value", 1));
  const MitsubaProperty* values = spectrum.find("values");
  const MitsubaProperty* const wavelengths = spectrum.find("wavelengths");
  if (type == "irregular" && values != nullptr && wavelengths != nullptr) {
    const std::vector<double> nm = numbers_of(wavelengths->text, spectrum.place);
    const std::vector<double> value = numbers_of(values->text, spectrum.place);
    SpectrumTable table;
    for (std::size_t i = 0; i < std::min(nm.size(), value.size()); ++i)
      table.points.emplace_back(nm[i], value[i]);
    if (table.points.empty() || !std::is_sorted(nm.begin(), nm.end()))
      refuse_at(spectrum.place, "spectrum must have wavelengths in ascending order, with values");
    return color_of_table(table, emits);
  }
  for (const char* const key : {"color", "value", "rgb"})
    if (const MitsubaProperty* const color = spectrum.find(key))
      return property_color(mitsuba, *color, emits);
  mitsuba.notes().add("spectrum of type " + excerpt(type) + " is replaced by grey");
  return Vec3d(0.5);
}

struct TexturePlacing {
  double su = 1, sv = 1, du = 0, dv = 0;  // u' = su u + du
};

TexturePlacing placing_of(MitsubaScene& mitsuba, const MitsubaObject& texture) {
  TexturePlacing placing{texture.number("uscale", 1), texture.number("vscale", 1),
                         texture.number("uoffset", 0), texture.number("voffset", 0)};
  if (texture.find("to_uv") == nullptr) return placing;
  const Affined map = texture.map("to_uv");
  if (map.x.y != 0 || map.y.x != 0) mitsuba.notes().add("rotation of a texture is left out");
  return {map.x.x, map.y.y, map.origin.x, map.origin.y};
}

void add_mapping(SceneJson& json, const TexturePlacing& m) {
  if (m.su == 1 && m.sv == 1 && m.du == 0 && m.dv == 0) return;
  json["mapping"] = {
      {"type", "uv"}, {"repeat_u", m.su}, {"repeat_v", m.sv}, {"shift_u", m.du}, {"shift_v", m.dv}};
}

ImportValue bitmap(MitsubaScene& mitsuba, const MitsubaObject& texture, TextureSide side) {
  texture.ignore({"filter_type", "format", "accel", "filter_mode", "cache", "max_anisotropy"});
  const bool raw = texture.flag("raw", false) || texture.number("gamma", -1) == 1;
  const std::string wrap = texture.text("wrap_mode", texture.text("wrap_mode_u", "repeat"));
  const bool is_known = wrap == "repeat" || wrap == "mirror" || wrap == "clamp";
  if (!is_known) mitsuba.notes().add("wrap mode " + excerpt(wrap) + " is replaced by clamp");
  const std::string file = texture.text("filename", "");
  SceneJson json{{"type", "image"},
                 {"file", mitsuba.scene.file_name(file)},
                 {"encoding", raw ? "linear" : "srgb"},
                 {"wrap", is_known ? wrap : "clamp"}};
  TexturePlacing m = placing_of(mitsuba, texture);
  if (side == TextureSide::flipped_v)
    m.dv = 1 - m.sv - m.dv;
  else
    m = {m.su, -m.sv, m.du, 1 - m.dv};
  add_mapping(json, m);
  ImportValue value;
  value.texture = mitsuba.scene.texture(file, std::move(json));
  if (value.is_constant()) value = grey(0.5);
  return value;
}

// Cells have side 1/2.
ImportValue mitsuba_checkerboard(MitsubaScene& mitsuba, const MitsubaObject& texture, TextureSide side) {
  const ImportValue even = mitsuba_color(mitsuba, texture, "color0", grey(0.4), side);
  const ImportValue odd = mitsuba_color(mitsuba, texture, "color1", grey(0.2), side);
  SceneJson json{{"type", "checker"},
                 {"even", mitsuba.scene.color(even.mean())},
                 {"odd", mitsuba.scene.color(odd.mean())}};
  TexturePlacing m = placing_of(mitsuba, texture);
  if (side == TextureSide::flipped_v) m = {m.su, -m.sv, m.du, m.sv + m.dv};
  add_mapping(json, {2 * m.su, 2 * m.sv, 2 * m.du, 2 * m.dv});
  ImportValue value;
  value.texture = mitsuba.scene.texture("checkerboard", std::move(json));
  if (value.is_constant()) value.factor = (even.mean() + odd.mean()) / 2;
  return value;
}

}  // namespace

Vec3d mitsuba_emission(MitsubaScene& mitsuba, const MitsubaObject& object, std::string_view name,
                       const Vec3d& fallback) {
  if (const MitsubaProperty* const found = object.find(name)) return property_color(mitsuba, *found, true);
  const MitsubaObject* const child = mitsuba.document.named_child(object, name);
  if (child == nullptr) return fallback;
  return object_color(mitsuba, *child, true);
}

ImportValue mitsuba_texture(MitsubaScene& mitsuba, const MitsubaObject& texture, TextureSide side) {
  mitsuba.scene.at(texture.place);
  if (texture.type == "bitmap") return bitmap(mitsuba, texture, side);
  if (texture.type == "checkerboard") return mitsuba_checkerboard(mitsuba, texture, side);
  if (texture.type == "scale")
    if (const MitsubaObject* const inner = mitsuba.document.child(texture, "texture")) {
      if (inner->type == "scale") refuse_at(texture.place, "texture scale must not scale another one");
      ImportValue value = mitsuba_texture(mitsuba, *inner, side);
      value.factor = value.factor * texture.number("scale", 1);
      return value;
    }
  mitsuba.notes().add("texture of type " + excerpt(texture.type) + " is replaced by grey");
  return grey(0.5);
}

ImportValue mitsuba_color(MitsubaScene& mitsuba, const MitsubaObject& object, std::string_view name,
                          const ImportValue& fallback, TextureSide side) {
  if (const MitsubaProperty* const found = object.find(name)) return {property_color(mitsuba, *found, false)};
  const MitsubaObject* const child = mitsuba.document.named_child(object, name);
  if (child == nullptr) return fallback;
  if (child->tag == "spectrum") return {object_color(mitsuba, *child, false)};
  return mitsuba_texture(mitsuba, *child, side);
}

}  // namespace orrery
