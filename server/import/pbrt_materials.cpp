#include <algorithm>
#include <cmath>

#include "core/meshes/text.h"
#include "core/params/params.h"
#include "server/import/pbrt_scene.h"

namespace orrery {
namespace {

// Reads materials of one type each.
class PbrtMaterialReader {
 public:
  PbrtMaterialReader(PbrtScene& pbrt, const PbrtParameters& parameters) : pbrt_(pbrt), p_(parameters) {}

  std::optional<SceneJson> read(const std::string& type) {
    pbrt_.scene.at(p_.place());
    if (type == "interface" || type.empty() || type == "none") {
      pbrt_.notes().add("surface without a material, such as the boundary of a medium, is left out");
      return std::nullopt;
    }
    if (type == "mix") return mix();
    SceneJson json = surface(type);
    add_relief(json);
    p_.note_unused(pbrt_.notes(), "material " + excerpt(type));
    return json;
  }

 private:
  SceneJson surface(const std::string& type) {
    if (type == "diffuse") return {{"type", "lambert"}, {"reflectance", color("reflectance", 0.5)}};
    if (type == "coateddiffuse") return coated_diffuse();
    if (type == "conductor") return conductor("", "");
    if (type == "coatedconductor") return coated_conductor();
    if (type == "dielectric")
      return {{"type", "glass"}, {"ior", ior("eta", 1.5, 0.1)}, {"roughness", roughness("", 0)}};
    if (type == "thindielectric") return pane_json(pbrt_.scene, ior("eta", 1.5, 0.1));
    if (type == "diffusetransmission") return diffuse_transmission();
    if (type == "subsurface") return subsurface();
    if (type == "hair" || type == "measured") return replaced(type);
    refuse_at(p_.place(),
              "type of a material must be one of pbrt's, such as diffuse (got " + excerpt(type) + ")");
  }

  SceneJson color(std::string_view name, double fallback) {
    return color_json(pbrt_.scene, pbrt_color(pbrt_, p_, name, grey(fallback)));
  }

  SceneJson replaced(const std::string& type) {
    pbrt_.notes().add("material " + excerpt(type) + " is replaced by a matt one");
    return {{"type", "lambert"}, {"reflectance", pbrt_.scene.color(Vec3d(type == "hair" ? 0.1 : 0.5))}};
  }

  // Returns an index of refraction: a number, or a spectrum at 589 nm.
  double ior(std::string_view name, double fallback, double least) {
    const PbrtParameter* const found = p_.find(name);
    if (found == nullptr) return fallback;
    double n = fallback;
    if (found->texts.empty()) {
      n = found->type == "spectrum" ? p_.index_table(name, pbrt_.spectra).at(589) : p_.number(name, fallback);
    } else if (const auto known = index_of(found->texts[0])) {
      n = *known;
      pbrt_.notes().add("dispersion of glass is left out");
    } else {
      n = p_.index_table(name, pbrt_.spectra).at(589);
    }
    if (!(n >= least && n <= 10))
      pbrt_.notes().add("index of refraction outside of " + number_text(least) + " to 10 is clamped");
    return std::clamp(n, least, 10.0);
  }

  // Returns the parameter of scenes for "roughness", or "uroughness" and "vroughness", after a prefix.
  SceneJson roughness(const std::string& prefix, double fallback) {
    const bool remap = p_.flag("remaproughness", true);
    const ImportValue both = pbrt_number(pbrt_, p_, prefix + "roughness", fallback);
    const auto along = [&](const char* axis) {
      const std::string name = prefix + axis;
      return p_.find(name) != nullptr ? pbrt_number(pbrt_, p_, name, fallback) : both;
    };
    const ImportValue u = along("uroughness"), v = along("vroughness");
    if (!u.is_constant() || !v.is_constant()) {
      pbrt_.notes().add("textured roughness is used as it is, without pbrt's mapping to alpha");
      return number_json(pbrt_.scene, u.is_constant() ? v : u, 0, 1);
    }
    const auto alpha = [&](const ImportValue& value) {
      const double x = std::max(value.mean().x, 0.0);
      return remap ? std::sqrt(x) : x;
    };
    if (u.mean().x != v.mean().x) pbrt_.notes().add("anisotropic roughness is replaced by its mean");
    return roughness_of_alpha(std::sqrt(alpha(u) * alpha(v)));
  }

  void note_layer() {
    p_.ignore({"maxdepth", "nsamples"});
    if (p_.find("albedo") != nullptr || p_.find("g") != nullptr)
      pbrt_.notes().add("medium between the layers of a material is left out");
  }

  SceneJson coated_diffuse() {
    note_layer();
    p_.ignore({"thickness"});
    return {{"type", "plastic"},
            {"reflectance", color("reflectance", 0.5)},
            {"ior", ior("eta", 1.5, 1)},
            {"roughness", roughness("", 0)}};
  }

  // Returns indices by a parameter of the spectrum type: "metal-Cu-eta", colours or tables.
  std::optional<Vec3d> indices(const std::string& name) {
    const PbrtParameter* const found = p_.find(name);
    if (found == nullptr) return std::nullopt;
    if (found->type == "rgb" || found->type == "float") return p_.surface_color(name, pbrt_.spectra);
    return indices_of(p_.index_table(name, pbrt_.spectra));
  }

  // Returns "Cu" if the parameter is "metal-Cu-eta", or "" for other spectra.
  std::string symbol(const std::string& name) {
    const PbrtParameter* const found = p_.find(name);
    if (found == nullptr) return "Cu";
    const std::string text = found->texts.empty() ? "" : found->texts[0];
    if (!text.starts_with("metal-")) return {};
    return text.substr(6, text.rfind('-') - 6);
  }

  SceneJson conductor(const std::string& prefix, const std::string& roughness_prefix) {
    SceneJson json{{"type", "metal"}};
    if (p_.find(prefix + "reflectance") != nullptr) {
      const ImportValue reflectance = pbrt_color(pbrt_, p_, prefix + "reflectance", grey(0.5));
      if (!reflectance.is_constant()) {
        json = {{"type", "metallic-roughness"},
                {"base_color", color_json(pbrt_.scene, reflectance)},
                {"metallic", 1}};
      } else {
        json["n"] = 1;
        json["k"] = extinction_json(pbrt_.scene, reflectance.mean());
      }
    } else if (const std::string metal = symbol(prefix + "eta"); !metal.empty()) {
      p_.find(prefix + "k");
      add_metal(pbrt_.scene, json, metal);
    } else {
      json["n"] = pbrt_.scene.color(indices(prefix + "eta").value_or(Vec3d(1)));
      json["k"] = pbrt_.scene.color(indices(prefix + "k").value_or(Vec3d(1)));
    }
    json["roughness"] = roughness(roughness_prefix, 0);
    return json;
  }

  SceneJson coated_conductor() {
    note_layer();
    p_.ignore({"thickness", "interface.eta", "interface.roughness"});
    pbrt_.notes().add("coat of a conductor is left out");
    return conductor(p_.find("reflectance") != nullptr ? "" : "conductor.", "conductor.");
  }

  SceneJson diffuse_transmission() {
    const double scale = p_.number("scale", 1);
    const auto share = [&](std::string_view name) {
      ImportValue value = pbrt_color(pbrt_, p_, name, grey(0.25));
      value.factor = value.factor * scale;
      return value;
    };
    return {{"type", "translucent"},
            {"reflectance", color_json(pbrt_.scene, share("reflectance"))},
            {"transmittance", color_json(pbrt_.scene, share("transmittance"))}};
  }

  // Returns the albedo and the mean free path in metres. Skin of default parameters: Jensen et al. 2001, in
  // 1 / mm. The albedo of a single scattering event for a diffuse reflectance: Chiang, Kutz and Burley,
  // "Practical and Controllable Subsurface Scattering for Production Path Tracing", 2016.
  SceneJson subsurface() {
    const double scale = p_.number("scale", 1);
    Vec3d albedo, path;
    if (p_.find("reflectance") != nullptr) {
      const Vec3d r = pbrt_color(pbrt_, p_, "reflectance", grey(0.5)).mean();
      path = p_.surface_color("mfp", pbrt_.spectra).value_or(Vec3d(1));
      for (std::size_t i = 0; i < 3; ++i)
        albedo[i] = 1 - std::exp(r[i] * (-5.09406 + r[i] * (2.61188 - 4.31805 * r[i])));
    } else {
      if (p_.find("name") != nullptr) pbrt_.notes().add("named medium of a subsurface material is replaced");
      const Vec3d absorbed = p_.surface_color("sigma_a", pbrt_.spectra).value_or(Vec3d(.0011, .0024, .014));
      const Vec3d scattered = p_.surface_color("sigma_s", pbrt_.spectra).value_or(Vec3d(2.55, 3.21, 3.77));
      for (std::size_t i = 0; i < 3; ++i) {
        const double extinction = absorbed[i] + scattered[i];
        albedo[i] = extinction > 0 ? scattered[i] / extinction : 0;
        path[i] = extinction > 0 ? 1 / (extinction * scale) : 1e12;
      }
    }
    const auto in_range = [](double x) { return std::clamp(x, 1e-12, 1e12); };
    return {{"type", "subsurface"},
            {"albedo", pbrt_.scene.color(albedo, 1)},
            {"mean_free_path", {in_range(path.x), in_range(path.y), in_range(path.z)}},
            {"anisotropy", std::clamp(p_.number("g", 0), -0.99, 0.99)},
            {"ior", ior("eta", 1.33, 0.1)},
            {"roughness", roughness("", 0)}};
  }

  std::optional<SceneJson> mix() {
    const PbrtParameter* const names = p_.find("materials");
    if (names == nullptr || names->texts.size() != 2)
      refuse_at(p_.place(), "material mix must have the names of two materials");
    pbrt_.notes().add("mix of materials is replaced by the larger share");
    const std::string& name = names->texts[pbrt_number(pbrt_, p_, "amount", 0.5).mean().x > 0.5 ? 1 : 0];
    const auto found = pbrt_.materials.find(name);
    if (found == pbrt_.materials.end() || found->second->type == "mix")
      refuse_at(p_.place(),
                "material mix must name materials that are defined and no mix (got " + excerpt(name) + ")");
    return PbrtMaterialReader(pbrt_, found->second->parameters).read(found->second->type);
  }

  void add_relief(SceneJson& json) {
    if (const std::string file = p_.text("normalmap", ""); !file.empty()) {
      const std::string texture = pbrt_image(pbrt_, file, "linear", PbrtParameters());
      if (!texture.empty()) json["normal_map"] = {{"texture", texture}};
    }
    if (p_.find("displacement") == nullptr) return;
    const ImportValue height = pbrt_number(pbrt_, p_, "displacement", 0);
    if (!height.is_constant())
      json["bump"] = {{"texture", height.texture}, {"scale", (height.inverted ? -1 : 1) * height.factor.x}};
  }

  PbrtScene& pbrt_;
  const PbrtParameters& p_;
};

}  // namespace

std::optional<SceneJson> pbrt_material(PbrtScene& pbrt, const std::string& type,
                                       const PbrtParameters& parameters) {
  return PbrtMaterialReader(pbrt, parameters).read(type);
}

}  // namespace orrery
