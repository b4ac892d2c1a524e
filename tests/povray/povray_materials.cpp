#include <algorithm>
#include <cmath>

#include "tests/povray/povray_scene.h"
#include "tests/povray/povray_text.h"

namespace orrery::povray {
namespace {

// Returns a / b per channel, because POV-Ray supports only multiples of the pigment `b`. Throws
// UnsupportedFeature if a channel of `b` is 0 and the same channel of `a` is not.
Vec3d ratio(const Vec3d& a, const Vec3d& b) {
  const auto one = [](double x, double of) {
    if (of == 0 && x != 0)
      throw UnsupportedFeature("cannot export ambient light: its colour has a channel that kd lacks");
    return of == 0 ? 0 : x / of;
  };
  return {one(a.x, b.x), one(a.y, b.y), one(a.z, b.z)};
}

// The pigment is Orrery's diffuse colour. POV-Ray's highlights have the colour of the light. `phong` is a
// power of the cosine at the mirrored direction, as in Orrery. `specular` is a power 1 / roughness of the
// cosine at the half vector.
Material rough(const Json& m, const Json& textures) {
  const Vec3d cd = vector_of(m, "diffuse_color", Vec3d(1));
  const bool textured = m.contains("kd") && m.at("kd").is_object();
  const Vec3d kd = textured ? Vec3d(1) : coefficient_of(m, "kd", Vec3d(0.8));
  const Vec3d ambient = ratio(coefficient_of(m, "ka", kd) * cd, kd * cd);
  const Vec3d highlight = coefficient_of(m, "ks", Vec3d(0)) * vector_of(m, "specular_color", Vec3d(1));
  if (highlight.x != highlight.y || highlight.y != highlight.z)
    throw UnsupportedFeature("cannot export highlight: ks must be grey");
  const double shininess = m.value("shininess", 20.0);
  if (shininess == 0 && highlight.x > 0)
    throw UnsupportedFeature("cannot export highlight: shininess must be > 0");
  std::string finish = "diffuse 1 ambient rgb " + text(ambient);
  if (highlight.x > 0)
    finish += m.value("shading", "blinn-phong") == "phong"
                  ? " phong " + text(highlight.x) + " phong_size " + text(shininess)
                  : " specular " + text(highlight.x) + " roughness " + text(1 / shininess);
  const std::string pigment =
      textured ? pigment_of(m.at("kd"), textures, cd) : "pigment { rgb " + text(kd * cd) + " } ";
  return {pigment + "finish { " + finish + " } ", false};
}

// Schlick's approximation corresponds to a POV-Ray reflection from F0 to 1 with falloff 5, the exponent of (1
// - cos).
Material reflective(const Json& m) {
  if (m.value("fresnel", "schlick") != "schlick")
    throw UnsupportedFeature("cannot export metal: fresnel must be schlick");
  const Vec3d n = vector_of(m, "n"), k = vector_of(m, "k"), one(1);
  const Vec3d top = (n - one) * (n - one) + k * k, bottom = (n + one) * (n + one) + k * k;
  const Vec3d f0(top.x / bottom.x, top.y / bottom.y, top.z / bottom.z);
  return {"pigment { rgb 0 } finish { ambient 0 diffuse 0 reflection { rgb " + text(f0) +
              ", rgb 1 falloff 5 } } ",
          false};
}

// Exports the filter as a purely absorbing medium. An interior's fade_color would not affect internally
// reflected light.
Material refractive(const Json& m) {
  if (m.value("fresnel", "schlick") != "exact")
    throw UnsupportedFeature("cannot export refraction: fresnel must be exact");
  const Vec3d filter = vector_of(m, "filter", Vec3d(1));
  if (std::min({filter.x, filter.y, filter.z}) <= 0)
    throw UnsupportedFeature("cannot export filter: each channel must be > 0");
  const Vec3d absorption(-std::log(filter.x), -std::log(filter.y), -std::log(filter.z));
  std::string interior = "ior " + text(m.at("ior").get<double>());
  if (filter != Vec3d(1)) interior += " media { absorption rgb " + text(absorption) + " }";
  return {
      "pigment { rgbt 1 } finish { ambient 0 diffuse 0 reflection { 0, 1 fresnel on } conserve_energy } "
      "interior { " +
          interior + " } hollow ",
      true};
}

// POV-Ray multiplies ambient and diffuse light by 1 - transmit - filter, but no highlight, which is
// interpolated transparency. `filter` is multiplied by the pigment. Filtered transparency is therefore
// exported with Ct as the pigment, and only if kd is a multiple of Ct.
Material transparent(const Json& m) {
  const double kt = m.value("kt", 0.5);
  const Vec3d kd = coefficient_of(m, "kd", Vec3d(0.8)) * vector_of(m, "diffuse_color", Vec3d(1));
  if (m.contains("ka")) throw UnsupportedFeature("cannot export transparency: ka must be kd");
  if (m.value("blend", "interpolated") == "interpolated") {
    const Material front = rough(m, Json::object());
    const std::string pigment = "pigment { rgb " + text(kd);
    return {pigment + " transmit " + text(kt) + front.modifiers.substr(pigment.size()), true};
  }
  const Vec3d ct = vector_of(m, "transmission_color", Vec3d(1)), share = ratio(kd, ct);
  if (std::abs(share.x - share.y) > 1e-12 || std::abs(share.y - share.z) > 1e-12 || m.contains("ks") ||
      kt >= 1)
    throw UnsupportedFeature("cannot export filter: requires kd as a multiple of Ct, no ks, and kt below 1");
  const std::string own = text(share.x / (1 - kt));
  return {"pigment { rgb " + text(ct) + " filter " + text(kt) + " } finish { diffuse " + own +
              " ambient rgb " + own + " } ",
          true};
}

}  // namespace

Material material_of(const Json& material, const Json& textures) {
  const std::string type = material.at("type");
  if (type == "rough") return rough(material, textures);
  if (type == "reflective") return reflective(material);
  if (type == "refractive") return refractive(material);
  if (type == "transparent") return transparent(material);
  throw UnsupportedFeature("cannot export material of type " + type);
}

}  // namespace orrery::povray
