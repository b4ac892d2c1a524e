#include "core/lights/emitters.h"

#include <algorithm>
#include <cmath>
#include <vector>

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
              const Groups& groups, LightBatch<T>& out) const override {
    const auto emitter = broadcast_record<Emitter, T>(records_[static_cast<std::size_t>(choice.index)]);
    for (const int i : groups) put(emitter, surface, draws, i, MaskOf<N>(true), N(choice.probability), out);
  }

  void sample_each(const SurfaceBatch<T>& surface, const LightChoices<T>& choices, const PathDraws<T>& draws,
                   const Groups& groups, LightBatch<T>& out) const override {
    for_each_register(choices, groups, [&](int i, const auto& mine, const Emitter<N>& emitter) {
      put(emitter, surface, draws, i, mine, choices.probability.at(i), out);
    });
  }

  void pdf(const RayBatch<T>& rays, const HitBatch<T>& hits, const LightChoices<T>& choices,
           const Groups& groups, Array<T>& out) const override {
    for_each_register(choices, groups, [&](int i, const auto& mine, const Emitter<N>& emitter) {
      out.put(i, mine, emitter.pdf(rays.at(i), hits.t.at(i)) * choices.probability.at(i));
    });
  }

 private:
  template <class Visit>
  void for_each_register(const LightChoices<T>& choices, const Groups& groups, const Visit& visit) const {
    for (const int i : groups) {
      const IndexLanes<T> index = load_index<T>(choices.index, i);
      const auto mine = mask_cast<N>(index >= 0);
      if (any(mine)) visit(i, mine, fetch_records<Emitter, T>(records_, index, mine));
    }
  }

  // The shadow ray ends where it is as far above the emitter as rounding may move that or the ray's origin: a
  // point of the emitter itself is not lit by it.
  static void put(const Emitter<N>& emitter, const SurfaceBatch<T>& surface, const PathDraws<T>& draws, int i,
                  const MaskOf<N>& mine, const N& probability, LightBatch<T>& out) {
    const N zero(T(0));
    const auto [u, v] = draws.two(SampleSet::light, i);
    const Vec3<N> from = surface.position.at(i);
    const auto drawn = emitter.draw(from, u, v);
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
  const double length_a = orrery::length(patch.a), length_b = orrery::length(patch.b);
  const Vec3d product = cross(patch.a, patch.b), normal = safe_normalize(product);
  const double pi = std::numbers::pi, parallelogram = orrery::length(product);
  Emitter<double> e{patch.at, patch.a,  patch.b,  normal,
                    radiance, length_a, length_b, static_cast<double>(patch.kind),
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
  }
  return e;
}

std::optional<Emitter<double>> make_emitter(const Patch& patch, const Vec3d& radiance,
                                            const Affined& world_from_model) {
  using orrery::length;
  constexpr double kRounding = 1e-12;
  Patch placed{patch.kind, world_from_model.point(patch.at), world_from_model.vector(patch.a),
               world_from_model.vector(patch.b)};
  switch (patch.kind) {
    case Patch::Kind::triangle: break;
    case Patch::Kind::rectangle:
    case Patch::Kind::disk:
      if (!(std::abs(dot(placed.a, placed.b)) <= kRounding * length(placed.a) * length(placed.b))) return {};
      break;
    case Patch::Kind::sphere: {
      const Vec3d scale(length(world_from_model.x), length(world_from_model.y), length(world_from_model.z));
      if (!(max_component(abs(scale - Vec3d(scale.x))) <= kRounding * scale.x)) return {};
      placed.a = patch.a * scale.x;
      break;
    }
  }
  Emitter<double> emitter = make_emitter(placed, radiance);
  // Hits are off by what rounding moves them in the model, and on the way from there: see Placed.
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
