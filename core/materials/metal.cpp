#include "core/materials/metal.h"

#include <algorithm>

#include "core/materials/facet_albedo.h"
#include "core/materials/material_set.h"
#include "core/materials/metal_indices.h"
#include "core/materials/shading_frame.h"
#include "core/math/mirror.h"
#include "core/params/params.h"

namespace orrery {
namespace {

// Reads the index of refraction and the extinction coefficient, as numbers or by the name of a metal.
void read_indices(MaterialParams& p, MetalInputs<double>& into) {
  if (p.plain().form({{"n", "k"}, {"name"}}) == 0) {
    p.color(into.n, "n", "Index of refraction, per channel.");
    p.color(into.k, "k", "Extinction coefficient, per channel.");
    return;
  }
  std::array<std::string_view, kMetals> names;
  std::transform(metal_indices().begin(), metal_indices().end(), names.begin(),
                 [](const MetalIndices& metal) { return metal.name; });
  const std::string name = p.plain().choice("name", "Metal with measured indices.", names);
  const auto known = std::find(names.begin(), names.end(), name) - names.begin();
  const MetalIndices& metal = metal_indices()[static_cast<std::size_t>(known) % kMetals];
  into.n = metal.n;
  into.k = metal.k;
}

}  // namespace
template <>
void MetalInputs<double>::tabulate(double of_roughness) {
  alpha = of_roughness * of_roughness;
  if (alpha < kMinAlpha)
    alpha = 0;
  else
    albedo = ggx_albedo(alpha);
}

template <>
void MetalInputs<double>::read(MaterialParams& p) {
  p.number(roughness, "roughness",
           "Roughness from 0 (smooth) to 1; its square is the alpha of the GGX distribution.",
           {.min = 0, .max = 1}, 0.3);  // before n and k, which are not always read: see MaterialParams
  if (p.raise_texture(roughness, kMinTexturedRoughness)) roughness = kMinTexturedRoughness;
  read_indices(p, *this);
}

namespace {

template <class T>
class MetalKernel final : public MaterialRecords<Metal, T> {
 public:
  using N = Lanes<T>;
  using MaterialRecords<Metal, T>::MaterialRecords;

  void ambient(const RayBatch<T>&, const SurfaceBatch<T>& surface, const LaneGroups& groups, Lobes,
               const Vec3<T>& ambient, Vec3Array<T>& radiance) const override {
    const N zero(T(0)), one(T(1));
    const Vec3<N> from_everywhere(ambient);
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Metal<N>& metal) {
      radiance.put(i, mine, metal.f0 * from_everywhere * select(metal.alpha > zero, one, zero));
    });
  }

  void evaluate(const Directions<T>& directions, const SurfaceBatch<T>& surface, const LaneGroups& groups,
                Lobes, Vec3Array<T>& pi_bsdf_cos, Array<T>& pdf) const override {
    const N zero(T(0));
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Metal<N>& metal) {
      const Vec3<N> geometric = surface.geometric.at(i), light = directions.light.at(i);
      const Vec3<N> viewer = -directions.ray.at(i);
      const ShadingFrame<N> frame(surface.normal.at(i), geometric, viewer);
      const Vec3<N> local_viewer = frame.local(viewer), local_light = frame.local(light);
      const auto lit = mine && directions.reach.at(i) > zero &&
                       reflects(metal, local_viewer, local_light, directions.side_cosine(surface, i));
      pdf.put(i, mine, zero);
      if (!any(lit)) return;
      const auto scattered = metal.scattered(local_viewer, local_light);
      pi_bsdf_cos.put(i, lit, scattered.pi_bsdf_cos);
      pdf.put(i, lit, scattered.pdf);
    });
  }

  // Smooth metals mirror the ray. Rough metals mirror the ray about a visible microfacet, or sample a
  // cosine-weighted direction with the probability Metal::multiple_share().
  void sample(const RayBatch<T>& rays, const HitBatch<T>&, const SurfaceBatch<T>& surface,
              const PathDraws<T>& draws, const LaneGroups& groups, Lobes,
              ScatterBatch<T>& out) const override {
    const N zero(T(0));
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Metal<N>& metal) {
      const Vec3<N> direction = rays.direction.at(i), viewer = -direction;
      const Vec3<N> normal = surface.normal.at(i), geometric = surface.geometric.at(i);
      out.pdf.put(i, mine, zero);
      out.weight.put(i, mine, Vec3<N>(zero));
      const auto smooth = mine && !(metal.alpha > zero);
      if (any(smooth)) {
        out.direction.put(i, smooth, mirrored(direction, normal, geometric));
        out.weight.put(i, smooth, metal.reflectance(cosine_of(viewer, normal)));
      }
      const auto rough = mine && !smooth;
      if (!any(rough)) return;
      const ShadingFrame<N> frame(normal, geometric, viewer);
      const Vec3<N> local_viewer = frame.local(viewer);
      const Vec3<N> light = drawn(metal, frame, local_viewer, draws.two(SampleSet::lobe, i));
      const Vec3<N> local_light = frame.local(light);
      const auto leaves = rough && reflects(metal, local_viewer, local_light, dot(geometric, light));
      const auto scattered = metal.scattered(local_viewer, local_light);
      constexpr T kPi = std::numbers::pi_v<T>;  // pi_bsdf_cos contains a factor pi: see MaterialKernel
      out.direction.put(i, rough, select(leaves, light, geometric));
      out.weight.put(i, leaves, scattered.pi_bsdf_cos * (N(T(1)) / (kPi * scattered.pdf)));
      out.pdf.put(i, leaves, scattered.pdf);
    });
  }

  void specular(const RayBatch<T>& rays, const HitBatch<T>&, const SurfaceBatch<T>& surface,
                const LaneGroups& groups, SpecularBatch<T>& out) const override {
    const N zero(T(0)), one(T(1));
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Metal<N>& metal) {
      const Vec3<N> mirrored_share =
          metal.reflectance(cosine_of(-rays.direction.at(i), surface.normal.at(i)));
      out.reflectance.put(i, mine, mirrored_share * select(metal.alpha > zero, zero, one));
      out.transmittance.put(i, mine, Vec3<N>(zero));
      out.filter.put(i, mine, Vec3<N>(one));
    });
  }

 private:
  static N cosine_of(const Vec3<N>& viewer, const Vec3<N>& normal) {
    return min_first(N(T(1)), max_first(N(T(0)), dot(viewer, normal)));
  }

  // Returns the lanes of rough metals where both directions are above the shading surface, and the light is
  // also above the geometric surface.
  static MaskOf<N> reflects(const Metal<N>& metal, const Vec3<N>& local_viewer, const Vec3<N>& local_light,
                            const N& true_cosine) {
    const N zero(T(0));
    return metal.alpha > zero && local_viewer.z > zero && local_light.z > zero && true_cosine > zero;
  }

  // Samples a direction. point.u selects the lobe. The remainder of point.u, rescaled to [0, 1), and point.v
  // select the direction.
  static Vec3<N> drawn(const Metal<N>& metal, const ShadingFrame<N>& frame, const Vec3<N>& local_viewer,
                       const SamplePoint<N>& point) {
    const N one(T(1)), last(T(1) - std::numeric_limits<T>::epsilon() / 2);
    const N share = metal.multiple_share(local_viewer.z);
    const auto evenly = point.u < share;
    const N u = min_first(last, select(evenly, N(point.u / share), N((point.u - share) / (one - share))));
    const Ggx<N> facets{metal.alpha};
    const Vec3<N> facet = facets.visible_normal(local_viewer, u, point.v);
    return select(evenly, cosine_direction(frame.normal, u, point.v),
                  frame.world(mirrored_about(local_viewer, facet)));
  }
};

}  // namespace

MaterialType metal_type() {
  return {"metal", "A rough or smooth microfacet metal, coloured by Fresnel reflection.",
          make_material_set<Metal, MetalKernel>};
}

}  // namespace orrery
