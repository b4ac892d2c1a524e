#include "tests/support/materials.h"

#include "tests/support/batches.h"

namespace orrery::test {
namespace {

template <class T>
struct Batches {
  RayBatch<T> rays;
  HitBatch<T> hits;
  SurfaceBatch<T> surface;
  Vec3Array<T> light, pi_bsdf_cos;
  Array<T> reach, pdf;
  SpecularBatch<T> specular;
  ScatterBatch<T> scatter;
  Array<IndexOf<T>> slot;
  Vec3Array<T> radiance;
  LaneGroups groups;
};

// Fills the batch with cases. The remaining lanes have no material.
template <class T>
void fill(std::span<const typename Probe<T>::Case> cases, Batches<T>& b) {
  const int count = static_cast<int>(cases.size());
  b.groups = LaneGroups::covering(0, count, kWidth<T>);
  for (int i = 0; i < kBatchRoom; ++i) {
    const auto& one = cases[static_cast<std::size_t>(i < count ? i : 0)];
    b.rays.direction.set(i, one.direction);
    b.surface.normal.set(i, one.normal);
    b.surface.geometric.set(i, one.geometric);
    b.light.set(i, one.light);
    b.pi_bsdf_cos.set(i, Vec3<T>());
    b.reach[i] = 1;
    b.pdf[i] = 0;
    b.surface.side[i] = one.side;
    b.hits.t[i] = one.t;
    b.surface.travelled[i] = one.t;
    b.surface.material[i] = i < count ? 0 : -1;
  }
}

}  // namespace

template <class T>
Probe<T>::Probe(const Json& material)
    : scene_(load(scene_with(json("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1, 'material': 'it'}]"),
                             Json{{"materials", {{"white", nullptr}, {"it", material}}}}))) {
  for (const auto& set : scene_->materials)
    if (set->size() > 0) kernel_ = set->kernel(T(), 0);
}

template <class T>
std::vector<Vec3<T>> Probe<T>::reflected(std::span<const Case> cases) const {
  std::vector<Vec3<T>> found;
  for (const Evaluation& one : evaluated(cases)) found.push_back(one.pi_bsdf_cos);
  return found;
}

template <class T>
std::vector<typename Probe<T>::Evaluation> Probe<T>::evaluated(std::span<const Case> cases,
                                                               Lobes lobes) const {
  const auto b = std::make_unique<Batches<T>>();
  std::vector<Evaluation> found;
  while (!cases.empty()) {
    const auto some = cases.first(std::min<std::size_t>(cases.size(), kBatch));
    fill<T>(some, *b);
    kernel_->evaluate({b->rays.direction, b->light, b->reach}, b->surface, b->groups, lobes, b->pi_bsdf_cos,
                      b->pdf);
    for (int i = 0; i < static_cast<int>(some.size()); ++i)
      found.push_back({b->pdf[i] > 0 ? b->pi_bsdf_cos[i] : Vec3<T>(), b->pdf[i]});
    cases = cases.subspan(some.size());
  }
  return found;
}

// Uses a different seed for each batch, and a different pixel for each element of a batch.
template <class T>
std::vector<typename Probe<T>::Sampled> Probe<T>::sampled(const Case& one, int count, std::uint64_t seed,
                                                          Lobes lobes) const {
  const auto b = std::make_unique<Batches<T>>();
  const std::vector<Case> cases(kBatch, one);
  fill<T>(cases, *b);
  for (int i = 0; i < kBatchRoom; ++i) b->slot[i] = static_cast<IndexOf<T>>(i % kBatch);
  std::vector<Sampled> found;
  for (std::uint64_t batch = 0; static_cast<int>(found.size()) < count; ++batch) {
    const Draws draws((seed << 32) + batch, TileView{0, 0, kTileSide, kTileSide}, 0);
    kernel_->sample(b->rays, b->hits, b->surface, PathDraws<T>{draws, b->slot, 0}, b->groups, lobes,
                    b->scatter);
    for (int i = 0; i < kBatch && static_cast<int>(found.size()) < count; ++i)
      found.push_back({b->scatter.direction[i], b->scatter.weight[i], b->scatter.pdf[i]});
  }
  return found;
}

template <class T>
std::vector<typename Probe<T>::Specular> Probe<T>::specular(std::span<const Case> cases) const {
  const auto b = std::make_unique<Batches<T>>();
  std::vector<Specular> found;
  while (!cases.empty()) {
    const auto some = cases.first(std::min<std::size_t>(cases.size(), kBatch));
    fill<T>(some, *b);
    kernel_->specular(b->rays, b->hits, b->surface, b->groups, b->specular);
    const SpecularBatch<T>& s = b->specular;
    for (int i = 0; i < static_cast<int>(some.size()); ++i)
      found.push_back({s.reflectance[i], s.transmittance[i], s.refracted[i], s.filter[i]});
    cases = cases.subspan(some.size());
  }
  return found;
}

template <class T>
Vec3<T> Probe<T>::ambient(const Case& one, Lobes lobes) const {
  const auto b = std::make_unique<Batches<T>>();
  fill<T>(std::span(&one, 1), *b);
  kernel_->ambient(b->rays, b->surface, b->groups, lobes, Vec3<T>(T(1)), b->radiance);
  return b->radiance[0];
}

template <class T>
MaterialTraits Probe<T>::traits() const {
  MaterialTraits all;
  for (const auto& set : scene_->materials)
    if (set->size() > 0) all |= set->traits();
  return all;
}

template <class T>
ReflectionLimits Probe<T>::limits() const {
  for (const auto& set : scene_->materials)
    if (set->size() > 0) return set->limits(0);
  return {};
}

template class Probe<float>;
template class Probe<double>;

}  // namespace orrery::test
