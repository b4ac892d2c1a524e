#include <algorithm>
#include <cmath>

#include "core/meshes/text.h"
#include "core/params/params.h"
#include "server/import/mitsuba_scene.h"
#include "server/import/spectrum.h"

namespace orrery {
namespace {

constexpr int kMaxBsdfDepth = 16;  // nested bsdfs

class MitsubaBsdfReader {
 public:
  MitsubaBsdfReader(MitsubaScene& mitsuba, const MitsubaObject& bsdf, TextureSide side, int depth)
      : mitsuba_(mitsuba), bsdf_(bsdf), side_(side), depth_(depth) {
    if (depth > kMaxBsdfDepth)
      refuse_at(bsdf.place,
                "bsdfs must be nested at most " + std::to_string(kMaxBsdfDepth) + " deep (got more)");
  }

  std::optional<SceneJson> read() {
    mitsuba_.scene.at(bsdf_.place);
    const std::string& type = bsdf_.type;
    std::optional<SceneJson> json;
    if (type == "null") {
      mitsuba_.notes().add("surface without a material, such as the boundary of a medium, is left out");
    } else if (type == "twosided") {
      json = nested(0);
    } else if (type == "mask") {
      json = masked();
    } else if (type == "bumpmap" || type == "normalmap") {
      json = relief(type == "bumpmap");
    } else if (type == "blendbsdf" || type == "mixturebsdf") {
      mitsuba_.notes().add("blend of bsdfs is replaced by the larger share");
      json = nested(type == "blendbsdf" && color("weight", 0.5).mean().x > 0.5 ? 1 : 0);
    } else if (type == "coating" || type == "roughcoating") {
      mitsuba_.notes().add("coat of a bsdf is left out");
      json = nested(0);
    } else {
      json = surface(type);
    }
    bsdf_.note_unused(mitsuba_.notes());
    return json;
  }

 private:
  SceneJson surface(const std::string& type) {
    bsdf_.ignore({"nonlinear", "sample_visible", "distribution"});
    if (type == "diffuse") return {{"type", "lambert"}, {"reflectance", json_of_color("reflectance", 0.5)}};
    if (type == "roughdiffuse")
      return {{"type", "oren-nayar"},
              {"reflectance", json_of_color("reflectance", 0.5)},
              {"roughness", std::clamp(bsdf_.number("alpha", 0.2), 0.0, 1.0)}};
    if (type == "conductor" || type == "roughconductor") return conductor(type == "roughconductor");
    if (type == "dielectric" || type == "roughdielectric")
      return {
          {"type", "glass"}, {"ior", ior("bk7", 0.1)}, {"roughness", roughness(type == "roughdielectric")}};
    if (type == "thindielectric") return pane_json(mitsuba_.scene, ior("bk7", 0.1));
    if (type == "plastic" || type == "roughplastic")
      return {{"type", "plastic"},
              {"reflectance", json_of_color("diffuse_reflectance", 0.5)},
              {"ior", ior("polypropylene", 1)},
              {"roughness", roughness(type == "roughplastic")}};
    if (type == "principled" || type == "principledthin") return principled();
    if (type == "difftrans")
      return {{"type", "translucent"},
              {"reflectance", 0},
              {"transmittance", json_of_color("transmittance", 0.5)}};
    if (type == "phong" || type == "ward") return glossy(type);
    mitsuba_.notes().add("bsdf " + excerpt(type) + " is replaced by a matt one");
    return {{"type", "lambert"}, {"reflectance", 0.5}};
  }

  ImportValue color(std::string_view name, double fallback) {
    return mitsuba_color(mitsuba_, bsdf_, name, grey(fallback), side_);
  }
  SceneJson json_of_color(std::string_view name, double fallback) {
    return color_json(mitsuba_.scene, color(name, fallback));
  }

  // Returns the nested bsdf of this index.
  std::optional<SceneJson> nested(std::size_t index) {
    const std::vector<const MitsubaObject*> all = mitsuba_.document.children(bsdf_, "bsdf");
    if (all.empty())
      refuse_at(bsdf_.place, "bsdf " + excerpt(bsdf_.type) + " must have a nested bsdf (got none)");
    return mitsuba_bsdf(mitsuba_, *all[std::min(index, all.size() - 1)], side_, depth_ + 1);
  }

  std::optional<SceneJson> masked() {
    std::optional<SceneJson> json = nested(0);
    if (json) (*json)["opacity"] = number_json(mitsuba_.scene, color("opacity", 0.5), 0, 1);
    return json;
  }

  std::optional<SceneJson> relief(bool is_bump) {
    std::optional<SceneJson> json = nested(0);
    const MitsubaObject* const texture = mitsuba_.document.child(bsdf_, "texture");
    const double scale = bsdf_.number("scale", 1);
    if (!json || texture == nullptr) return json;
    const ImportValue value = mitsuba_texture(mitsuba_, *texture, side_);
    if (value.is_constant()) return json;
    if (is_bump)
      (*json)["bump"] = {{"texture", value.texture}, {"scale", scale * value.factor.x}};
    else
      (*json)["normal_map"] = {{"texture", value.texture}};
    return json;
  }

  double index(std::string_view name, const std::string& fallback) {
    const MitsubaProperty* const found = bsdf_.find(name);
    const std::string text = found == nullptr ? fallback : found->text;
    if (const auto known = index_of(text)) return *known;
    if (found != nullptr && found->tag == "string")
      refuse_at(found->place, std::string(name) + " must be a number or a material such as bk7 (got " +
                                  excerpt(text) + ")");
    return bsdf_.number(name, 1.5);
  }
  double ior(const std::string& interior, double least) {
    const double outside = index("ext_ior", "air");
    const double ratio = outside > 0 ? index("int_ior", interior) / outside : 1;
    if (!(ratio >= least && ratio <= 10))
      mitsuba_.notes().add("index of refraction outside of " + number_text(least) + " to 10 is clamped");
    for (const char* const name : {"specular_reflectance", "specular_transmittance"})
      if (bsdf_.find(name) != nullptr || mitsuba_.document.named_child(bsdf_, name) != nullptr)
        mitsuba_.notes().add("factor " + std::string(name) + " of a dielectric is left out");
    return std::clamp(ratio, least, 10.0);
  }

  SceneJson roughness(bool is_rough) {
    if (!is_rough) return 0;
    if (bsdf_.text("distribution", "beckmann") != "ggx")
      mitsuba_.notes().add("Beckmann distribution is replaced by GGX of the same alpha");
    const ImportValue both = color("alpha", 0.1);
    const ImportValue u = mitsuba_color(mitsuba_, bsdf_, "alpha_u", both, side_);
    const ImportValue v = mitsuba_color(mitsuba_, bsdf_, "alpha_v", both, side_);
    if (!u.is_constant() || !v.is_constant()) {
      mitsuba_.notes().add("textured alpha is used as roughness, which is its square root");
      return number_json(mitsuba_.scene, u.is_constant() ? v : u, 0, 1);
    }
    if (u.mean().x != v.mean().x) mitsuba_.notes().add("anisotropic roughness is replaced by its mean");
    return roughness_of_alpha(std::sqrt(std::max(0.0, u.mean().x) * std::max(0.0, v.mean().x)));
  }

  SceneJson conductor(bool is_rough) {
    SceneJson json{{"type", "metal"}};
    const bool has_indices =
        bsdf_.find("eta") != nullptr || mitsuba_.document.named_child(bsdf_, "eta") != nullptr;
    const std::string material = bsdf_.text("material", has_indices ? "" : "Cu");
    if (material == "none") {
      json["n"] = 1;
      json["k"] = 1000;  // reflects all light
    } else if (!material.empty()) {
      add_metal(mitsuba_.scene, json, material);
    } else {
      json["n"] = color_json(mitsuba_.scene, color("eta", 0), 1e6);
      json["k"] = color_json(mitsuba_.scene, color("k", 1), 1e6);
    }
    json["roughness"] = roughness(is_rough);
    if (const ImportValue tint = color("specular_reflectance", 1);
        !tint.is_constant() || !(tint.mean() == Vec3d(1))) {
      if (material == "none" || !tint.is_constant())
        return {{"type", "metallic-roughness"},
                {"base_color", color_json(mitsuba_.scene, tint)},
                {"metallic", 1},
                {"roughness", json["roughness"]}};
      mitsuba_.notes().add("factor specular_reflectance of a conductor is left out");
    }
    return json;
  }

  SceneJson principled() {
    if (bsdf_.number("spec_trans", 0) > 0.5)
      return {{"type", "glass"},
              {"ior", std::clamp(bsdf_.number("eta", 1.5), 0.1, 10.0)},
              {"roughness", number_json(mitsuba_.scene, color("roughness", 0.5), 0, 1)}};
    SceneJson json{{"type", "metallic-roughness"},
                   {"base_color", json_of_color("base_color", 0.5)},
                   {"metallic", number_json(mitsuba_.scene, color("metallic", 0), 0, 1)},
                   {"roughness", number_json(mitsuba_.scene, color("roughness", 0.5), 0, 1)}};
    // Reflectance along the normal: 0.08 "specular", or that of an index of refraction.
    const double eta = bsdf_.number("eta", 1.5);
    const double normal = bsdf_.find("eta") != nullptr ? std::pow((eta - 1) / (eta + 1), 2)
                                                       : 0.08 * bsdf_.number("specular", 0.5);
    json["normal_reflectance"] = std::clamp(normal, 0.0, 1.0);
    return json;
  }

  // Exponent e of Phong's lobe has the width of alpha = sqrt(2 / (e + 2)) (Walter et al. 2007).
  SceneJson glossy(const std::string& type) {
    mitsuba_.notes().add("bsdf " + excerpt(type) + " is replaced by plastic");
    bsdf_.ignore({"specular_reflectance"});
    const double alpha = type == "phong" ? std::sqrt(2 / (std::max(0.0, bsdf_.number("exponent", 30)) + 2))
                                         : bsdf_.number("alpha_u", bsdf_.number("alpha", 0.1));
    return {{"type", "plastic"},
            {"reflectance", json_of_color("diffuse_reflectance", 0.5)},
            {"roughness", roughness_of_alpha(alpha)}};
  }

  MitsubaScene& mitsuba_;
  const MitsubaObject& bsdf_;
  TextureSide side_;
  int depth_;
};

}  // namespace

std::optional<SceneJson> mitsuba_bsdf(MitsubaScene& mitsuba, const MitsubaObject& bsdf, TextureSide side,
                                      int depth) {
  return MitsubaBsdfReader(mitsuba, bsdf, side, depth).read();
}

}  // namespace orrery
