#include "core/lights/emitters.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/lights/solid_emitter.h"
#include "core/math/bounds.h"
#include "core/model/record.h"

namespace orrery {
namespace {

template <class T>
class EmitterKernel final : public LightKernel<T> {
 public:
  using N = Lanes<T>;

  explicit EmitterKernel(std::span<const Emitter<double>> emitters) {
    for (const auto& emitter : emitters) records_.push_back(convert_record<Emitter, T, double>(emitter));
  }

  void sample(const SurfaceBatch<T>& surface, const LightChoice<T>& choice, const PathDraws<T>& draws,
              const LaneGroups& groups, LightBatch<T>& out) const override {
    const auto emitter = broadcast_record<Emitter, T>(records_[static_cast<std::size_t>(choice.index)]);
    for (const int i : groups) put(emitter, surface, draws, i, MaskOf<N>(true), N(choice.probability), out);
  }

  void sample_each(const SurfaceBatch<T>& surface, const LightChoices<T>& choices, const PathDraws<T>& draws,
                   const LaneGroups& groups, LightBatch<T>& out) const override {
    for_each_register(choices, groups, [&](int i, const auto& mine, const Emitter<N>& emitter) {
      put(emitter, surface, draws, i, mine, choices.probability.at(i), out);
    });
  }

  void pdf(const RayBatch<T>& rays, const HitBatch<T>& hits, const LightChoices<T>& choices,
           const LaneGroups& groups, Array<T>& out) const override {
    for_each_register(choices, groups, [&](int i, const auto& mine, const Emitter<N>& emitter) {
      out.put(i, mine, pdf_of(emitter, rays.at(i), hits.t.at(i)) * choices.probability.at(i));
    });
  }

 private:
  template <class Visit>
  void for_each_register(const LightChoices<T>& choices, const LaneGroups& groups, const Visit& visit) const {
    for (const int i : groups) {
      const IndexLanes<T> index = load_index<T>(choices.index, i);
      const auto mine = mask_cast<N>(index >= 0);
      if (any(mine)) visit(i, mine, fetch_records<Emitter, T>(records_, index, mine));
    }
  }

  using LightSample = typename Emitter<N>::LightSample;
  static LightSample draw(const Emitter<N>& emitter, const Vec3<N>& from, const N& u, const N& v) {
    const auto mine = emitter.is_solid();
    const LightSample other = emitter.draw(from, u, v);
    if (!any(mine)) return other;
    const LightSample drawn = SolidEmitter<N>(emitter, from).draw(u, v);
    return {select(mine, drawn.point, other.point), select(mine, drawn.normal, other.normal),
            select(mine, drawn.pdf, other.pdf)};
  }
  static N pdf_of(const Emitter<N>& emitter, const Ray<N>& ray, const N& t) {
    const auto mine = emitter.is_solid();
    const N other = emitter.pdf(ray, t);
    return any(mine) ? select(mine, SolidEmitter<N>(emitter, ray.origin).pdf(ray, t), other) : other;
  }

  // Fills one register of `out`. The shadow ray ends before the emitter, at a distance that bounds the
  // rounding errors of the emitter and of the ray's origin. The emitter therefore does not occlude its own
  // light, and a point on the emitter does not light itself.
  static void put(const Emitter<N>& emitter, const SurfaceBatch<T>& surface, const PathDraws<T>& draws, int i,
                  const MaskOf<N>& mine, const N& probability, LightBatch<T>& out) {
    const N zero(T(0));
    const auto [u, v] = draws.two(SampleSet::light, i);
    const Vec3<N> from = surface.position.at(i);
    const LightSample drawn = draw(emitter, from, u, v);
    const N step = T(2) * (emitter.magnitude * (8 * std::numeric_limits<T>::epsilon()) + surface.step.at(i));
    const Vec3<N> line = drawn.point - from;
    const N distance = length(line), pdf = drawn.pdf * probability;
    const Vec3<N> toward = line * select(distance > zero, N(T(1) / distance), zero);
    using std::abs;
    const N cosine = abs(dot(toward, drawn.normal));
    const N reach = distance - step / max_first(cosine, N(std::numeric_limits<T>::min()));
    const auto shines = pdf > zero && reach > zero && pdf < N(std::numeric_limits<T>::max());
    out.shadow.direction.put(i, mine, toward);
    out.shadow.t_max.put(i, mine, select(shines, reach, N(T(-1))));
    constexpr T kPi = std::numbers::pi_v<T>;
    out.incident.put(i, mine, emitter.radiance * select(shines, N(T(1) / (kPi * pdf)), zero));
    out.pdf.put(i, mine, pdf);
  }

  std::vector<Emitter<T>> records_;
};

}  // namespace

Emitter<double> make_emitter(const Patch& patch, const Vec3d& radiance) {
  using orrery::length;
  const double length_a = length(patch.a), length_b = length(patch.b), length_c = length(patch.c);
  const Vec3d product = cross(patch.a, patch.b), normal = safe_normalize(product);
  const double pi = std::numbers::pi, parallelogram = length(product);
  Emitter<double> e{patch.at, patch.a,  patch.b,
                    normal,   radiance, length_a,
                    length_b, length_c, static_cast<double>(patch.kind),
                    0,        0};
  const Boundsd box = Boundsd::of({patch.at, patch.at + patch.a, patch.at + patch.b,
                                   patch.at + patch.a + patch.b, patch.at - patch.a - patch.b});
  e.magnitude = box.magnitude();
  switch (patch.kind) {
    case Patch::Kind::rectangle:
      e.a = patch.a / length_a;
      e.b = patch.b / length_b;
      e.area = parallelogram;
      break;
    case Patch::Kind::triangle: e.area = parallelogram / 2; break;
    case Patch::Kind::disk: e.area = parallelogram * pi; break;
    case Patch::Kind::sphere:
      e.length_a = patch.a.x;
      e.area = 4 * pi * patch.a.x * patch.a.x;
      e.magnitude = max_component(abs(patch.at)) + patch.a.x;
      break;
    case Patch::Kind::box:
    case Patch::Kind::cylinder:
      e.a = patch.a / length_a;
      e.b = patch.b / length_b;
      e.normal = patch.c / length_c;
      e.area = patch.kind == Patch::Kind::box
                   ? 8 * (length_a * length_b + length_b * length_c + length_c * length_a)
                   : 2 * pi * length_a * (2 * length_c + length_a);
      e.magnitude = max_component(abs(patch.at) + abs(patch.a) + abs(patch.b) + abs(patch.c));
      break;
  }
  return e;
}

std::optional<Emitter<double>> make_emitter(const Patch& patch, const Vec3d& radiance,
                                            const Affined& world_from_model) {
  using orrery::length;
  constexpr double kRounding = 1e-12;
  Patch placed{patch.kind, world_from_model.point(patch.at), world_from_model.vector(patch.a),
               world_from_model.vector(patch.b), world_from_model.vector(patch.c)};
  const auto square = [](const Vec3d& x, const Vec3d& y) {
    return std::abs(dot(x, y)) <= kRounding * length(x) * length(y);
  };
  const auto as_long = [](double x, double y) { return std::abs(x - y) <= kRounding * x; };
  switch (patch.kind) {
    case Patch::Kind::triangle: break;
    case Patch::Kind::rectangle:
    case Patch::Kind::disk:
      if (!square(placed.a, placed.b)) return {};
      break;
    case Patch::Kind::sphere: {
      const auto& [x, y, z, origin] = world_from_model;
      if (!as_long(length(x), length(y)) || !as_long(length(x), length(z))) return {};
      placed.a = patch.a * length(x);
      break;
    }
    case Patch::Kind::cylinder:
      if (!as_long(length(placed.a), length(placed.b))) return {};
      [[fallthrough]];
    case Patch::Kind::box:
      if (!square(placed.a, placed.b) || !square(placed.a, placed.c) || !square(placed.b, placed.c))
        return {};
      break;
  }
  Emitter<double> emitter = make_emitter(placed, radiance);
  // Rounding moves hits both in the model and in the transformation to the world: see
  // PlacedInstance::step_base.
  const double in_model = make_emitter(patch, radiance).magnitude;
  const double moved = stretch(world_from_model) * in_model + max_component(abs(world_from_model.origin));
  emitter.magnitude = std::max(emitter.magnitude, 2 * moved);
  return emitter;
}

LightBounds bounds_of(const Emitter<double>& e) {
  using orrery::length;
  LightBounds bounds{.centre = e.at, .radius = e.length_a, .normal = e.normal};
  double seen_area = e.area;
  switch (static_cast<Patch::Kind>(e.kind)) {
    case Patch::Kind::rectangle: {
      const Vec3d a = e.a * e.length_a, b = e.b * e.length_b;
      bounds.centre = e.at + (a + b) * 0.5;
      bounds.radius = std::max(length(a + b), length(a - b)) / 2;
      break;
    }
    case Patch::Kind::triangle: {
      const Vec3d middle = (e.a + e.b) / 3.0;
      bounds.centre = e.at + middle;
      bounds.radius = std::max({length(middle), length(e.a - middle), length(e.b - middle)});
      break;
    }
    case Patch::Kind::disk: bounds.radius = std::max(e.length_a, e.length_b); break;
    case Patch::Kind::sphere:
      bounds.normal = Vec3d(0);
      seen_area /= 4;
      break;
    case Patch::Kind::box:
    case Patch::Kind::cylinder: {
      const double across =
          e.kind == static_cast<double>(Patch::Kind::box) ? std::hypot(e.length_a, e.length_b) : e.length_a;
      bounds.radius = std::hypot(across, e.length_c);
      bounds.normal = Vec3d(0);
      seen_area /= 4;  // mean projected area of a convex body (Cauchy)
      break;
    }
  }
  bounds.strength = 2 * max_component(e.radiance);
  bounds.attenuation = {1, 0, 2 * std::numbers::pi / seen_area};
  return bounds;
}

template <class T>
LightKernelPtr<T> make_emitters(std::span<const Emitter<double>> emitters) {
  return std::make_unique<EmitterKernel<T>>(emitters);
}

template LightKernelPtr<float> make_emitters<float>(std::span<const Emitter<double>>);
template LightKernelPtr<double> make_emitters<double>(std::span<const Emitter<double>>);

}  // namespace orrery
