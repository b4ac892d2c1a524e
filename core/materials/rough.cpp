#include "core/materials/material_set.h"
#include "core/math/elementary.h"
#include "core/params/params.h"

namespace orrery {
namespace {

template <class N>
struct Rough {
  Vec3<N> ambient, diffuse, specular;  // coefficient times colour
  N shininess;
  N phong;  // 1: the mirrored light direction decides the highlight, 0: the half vector

  static Rough<double> read(Params& p) {
    const Vec3d kd = p.coefficient("kd", "Diffuse coefficient.", Vec3d(0.8));
    const Vec3d ka = p.coefficient("ka", "Ambient coefficient; kd if left out.", derived(kd));
    const Vec3d ks = p.coefficient("ks", "Specular coefficient.", Vec3d(0));
    const Vec3d cd = p.color("cd", "Colour that multiplies ka and kd.", Vec3d(1));
    const Vec3d cs = p.color("cs", "Colour that multiplies ks.", Vec3d(1));
    const double shininess =
        p.number("shininess", "Exponent of the highlight.", {.min = 0, .max = 1e6}, 20.0);
    const bool phong =
        p.choice("shading", "Model of the highlight.", {"blinn-phong", "phong"}, "blinn-phong") == "phong";
    return {ka * cd, kd * cd, ks * cs, shininess, phong ? 1.0 : 0.0};
  }
  MaterialTraits traits() const { return {.lit = true}; }

  // Cosine that the highlight is a power of, 0 where there is none. Unit vectors: normal, toward the light,
  // toward the viewer, and half way between the two. The mirrored direction is R = 2 (N.L) N - L.
  N highlight(const Vec3<N>& normal, const Vec3<N>& light, const Vec3<N>& viewer, const Vec3<N>& half,
              const N& cosine) const {
    using T = ScalarOf<N>;
    const N mirrored = T(2) * cosine * dot(normal, viewer) - dot(light, viewer);
    const N c = select(phong > N(T(0)), mirrored, dot(normal, half));
    return min_first(N(T(1)), max_first(N(T(0)), c));
  }
};

// H = (L + V) / |L + V|; zero where the two are opposite.
template <class N>
Vec3<N> half_vector(const Vec3<N>& light, const Vec3<N>& viewer) {
  using T = ScalarOf<N>;
  using std::sqrt;
  const Vec3<N> sum = light + viewer;
  const N size2 = dot(sum, sum);
  return sum * select(size2 > N(T(0)), N(T(1) / sqrt(size2)), N(T(0)));
}

template <class T>
class RoughKernel final : public MaterialRecords<Rough, T> {
 public:
  using N = Lanes<T>;
  using MaterialRecords<Rough, T>::MaterialRecords;

  void ambient(const SurfaceBatch<T>& surface, const Groups& groups, const Vec3<T>& ambient,
               Vec3Array<T>& radiance) const override {
    const Vec3<N> from_everywhere(ambient);
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Rough<N>& rough) {
      radiance.put(i, mine, rough.ambient * from_everywhere);
    });
  }

  // No light reaches a side that faces away, neither diffuse nor as a highlight.
  void reflect(const RayBatch<T>& rays, const SurfaceBatch<T>& surface, const Groups& groups,
               LightBatch<T>& light) const override {
    const N zero(T(0));
    const auto half_at = [&](int i) {
      return half_vector(light.shadow.direction.at(i), -rays.direction.at(i));
    };
    const Vec3<N> first_half = half_at(*groups.begin());
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Rough<N>& rough) {
      const Vec3<N> normal = surface.normal.at(i), toward = light.shadow.direction.at(i);
      const N cosine = dot(normal, toward);
      const auto lit = mine && light.shadow.t_max.at(i) > zero && cosine > zero &&
                       dot(surface.geometric.at(i), toward) > zero;
      light.shadow.t_max.put(i, mine && !lit, N(T(-1)));
      if (!any(lit)) return;
      Vec3<N> reflected = rough.diffuse * cosine;
      if (any(lit && max_component(rough.specular) > zero)) {
        const Vec3<N> viewer = -rays.direction.at(i);
        const Vec3<N> half = light.constant_half ? first_half : half_at(i);
        const N base = rough.highlight(normal, toward, viewer, half, cosine);
        const N lobe = select(dot(normal, viewer) > zero, pow_unit(base, rough.shininess), zero);
        reflected = reflected + rough.specular * lobe;
      }
      light.radiance.put(i, mine, light.incident.at(i) * reflected);
    });
  }
};

}  // namespace

MaterialType rough_type() {
  return {"rough", "Ambient, Lambert diffuse and a Phong or Blinn-Phong highlight.",
          make_material_set<Rough, RoughKernel>};
}

}  // namespace orrery
