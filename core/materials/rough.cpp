#include "core/materials/rough.h"

#include <numbers>

#include "core/materials/lobes.h"
#include "core/math/hemisphere.h"
#include "core/params/params.h"

namespace orrery {

template <>
void RoughInputs<double>::read(MaterialParams& p) {
  p.coefficient(kd, "kd", "Diffuse coefficient.", Vec3d(0.8));
  p.coefficient_like(ka, "ka", "Ambient coefficient; default: kd.", kd, 1, 0);
  p.coefficient(ks, "ks", "Specular coefficient.", Vec3d(0));
  p.color(diffuse_color, "diffuse_color", "Colour that multiplies ka and kd.", Vec3d(1));
  p.color(specular_color, "specular_color", "Colour that multiplies ks.", Vec3d(1));
  p.number(shininess, "shininess", "Exponent of the highlight.", {.min = 0, .max = 1e6}, 20.0);
  phong = p.plain().choice("shading", "Highlight model.", {"blinn-phong", "phong"}, "blinn-phong") == "phong";
}

Rough<double> read_rough(Params& p) {
  RoughInputs<double> inputs{};
  MaterialParams plain(p, nullptr, reinterpret_cast<double*>(&inputs));
  inputs.read(plain);
  return inputs.record();
}

// A relative error epsilon of the cosine becomes a relative error of shininess * epsilon in the highlight.
template <class N>
RoundingLimit Rough<N>::rounding() const {
  constexpr double kMaxError = 2e-3;
  if (specular == Vec3d(0) || shininess == 0) return {};
  return {kMaxError / shininess, "its highlight has an exponent of " + number_text(shininess)};
}

// Returns the albedo of a highlight with exponent s and coefficient 1: 8 (1 - 2^(-s / 2 - 1)) / (s + 2) for
// Blinn-Phong, and 2 / (s + 1) for Phong.
template <class N>
double Rough<N>::highlight_albedo() const {
  const double s = shininess;
  return phong > 0 ? 2 / (s + 1) : 8 * (1 - exp2_flushed(-(s + 2) / 2)) / (s + 2);
}

template <class N>
ReflectionLimits Rough<N>::limits() const {
  return {ambient, diffuse + specular, diffuse + specular * highlight_albedo()};
}

namespace {

template <class T>
class RoughKernel final : public MaterialRecords<Rough, T> {
 public:
  using N = Lanes<T>;
  using MaterialRecords<Rough, T>::MaterialRecords;

  void ambient(const RayBatch<T>&, const SurfaceBatch<T>& surface, const LaneGroups& groups, Lobes lobes,
               const Vec3<T>& ambient, Vec3Array<T>& radiance) const override {
    const Vec3<N> from_everywhere(with_diffuse(lobes) ? ambient : Vec3<T>());
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Rough<N>& rough) {
      radiance.put(i, mine, rough.ambient * from_everywhere);
    });
  }

  // Light from behind the surface contributes nothing.
  void evaluate(const Directions<T>& directions, const SurfaceBatch<T>& surface, const LaneGroups& groups,
                Lobes lobes, Vec3Array<T>& pi_bsdf_cos, Array<T>& pdf) const override {
    const N zero(T(0));
    const auto half_at = [&](int i) { return half_vector(directions.light.at(i), -directions.ray.at(i)); };
    const Vec3<N> first_half = half_at(*groups.begin());
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Rough<N>& rough) {
      const Vec3<N> normal = surface.normal.at(i), toward = directions.light.at(i);
      const N cosine = dot(normal, toward);
      auto lit =
          mine && directions.reach.at(i) > zero && cosine > zero && directions.side_cosine(surface, i) > zero;
      const auto shines = max_component(rough.specular) > zero;
      if (!with_diffuse(lobes)) lit = lit && shines;
      if (!any(lit)) return pdf.put(i, mine, N(zero));
      if (!with_non_diffuse(lobes) || !any(lit && shines)) {
        pdf.put(i, mine, select(lit, cosine_pdf(cosine), zero));
        return pi_bsdf_cos.put(i, mine, rough.diffuse * cosine);
      }
      const Vec3<N> viewer = -directions.ray.at(i);
      const Vec3<N> half = directions.constant_half ? first_half : half_at(i);
      const auto scattered = rough.scattered(normal, toward, viewer, half, cosine, lobes);
      pi_bsdf_cos.put(i, mine, scattered.pi_bsdf_cos);
      pdf.put(i, mine, select(lit, scattered.pdf, zero));
    });
  }

  void sample(const RayBatch<T>& rays, const HitBatch<T>&, const SurfaceBatch<T>& surface,
              const PathDraws<T>& draws, const LaneGroups& groups, Lobes lobes,
              ScatterBatch<T>& out) const override {
    const N zero(T(0));
    this->for_each_register(surface, groups, [&](int i, const auto& mine, const Rough<N>& rough) {
      const auto [u, v] = draws.two(SampleSet::lobe, i);
      const Vec3<N> normal = surface.normal.at(i), viewer = -rays.direction.at(i);
      const auto [shines, rest] = LobeDraw<N>{u, v, zero}.choose(rough.highlight_chance(lobes));
      Vec3<N> direction = cosine_direction(normal, rest, v);
      if (any(shines)) direction = select(shines, rough.drawn_highlight(normal, viewer, rest, v), direction);
      const N cosine = dot(normal, direction);
      const auto scattered =
          rough.scattered(normal, direction, viewer, half_vector(direction, viewer), cosine, lobes);
      const auto leaves = cosine > zero && dot(surface.geometric.at(i), direction) > zero &&
                          (!shines || dot(normal, viewer) > zero) && scattered.pdf > zero;
      const N pdf = select(leaves, scattered.pdf, zero);
      out.direction.put(i, mine, direction);
      constexpr T kPi = std::numbers::pi_v<T>;  // pi_bsdf_cos contains a factor pi: see MaterialKernel
      out.weight.put(i, mine, scattered.pi_bsdf_cos * select(leaves, N(T(1) / (kPi * pdf)), zero));
      out.pdf.put(i, mine, pdf);
    });
  }
};

}  // namespace

template struct Rough<double>;

MaterialKernelPtr<float> make_rough_kernel(float, std::span<const Rough<double>> records, int first) {
  return std::make_unique<RoughKernel<float>>(records, first);
}
MaterialKernelPtr<double> make_rough_kernel(double, std::span<const Rough<double>> records, int first) {
  return std::make_unique<RoughKernel<double>>(records, first);
}

MaterialType rough_type() {
  return {"rough", "Ambient and Lambert diffuse terms with a Phong or Blinn-Phong highlight.",
          make_material_set<Rough, RoughKernel>};
}

}  // namespace orrery
