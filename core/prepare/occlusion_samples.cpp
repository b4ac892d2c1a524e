#include "core/prepare/occlusion_samples.h"

#include "core/math/compress.h"
#include "core/prepare/trial.h"

namespace orrery {
namespace {

constexpr int kTiles = 24;
constexpr std::size_t kMost = 16'384;

template <class T>
struct ShadowRay {
  Ray<T> ray;
  T t_max;
};

// Keeps every n-th added ray. n is initially 1 and doubles whenever more than kMost rays are kept.
template <class T>
class DecimatingSampler {
 public:
  void add(const ShadowRay<T>& ray) {
    if (given_++ % every_ != 0) return;
    rays_.push_back(ray);
    if (rays_.size() <= kMost) return;
    for (std::size_t i = 0; 2 * i < rays_.size(); ++i) rays_[i] = rays_[2 * i];
    rays_.resize((rays_.size() + 1) / 2);
    every_ *= 2;
  }
  const std::vector<ShadowRay<T>>& rays() const { return rays_; }

 private:
  std::vector<ShadowRay<T>> rays_;
  std::uint64_t given_ = 0, every_ = 1;
};

// Accelerator wrapper that records shadow rays. Not thread-safe.
template <class T>
class Recorder final : public Accelerator<T> {
 public:
  Recorder(const Accelerator<T>& behind, DecimatingSampler<T>& into) : behind_(behind), into_(into) {}
  AcceleratorFacts facts() const override { return behind_.facts(); }
  void closest(const RayBatch<T>& rays, const LaneGroups& groups, HitBatch<T>& hits,
               AcceleratorCounts& counts) const override {
    behind_.closest(rays, groups, hits, counts);
  }
  void occlude(RayBatch<T>& rays, const LaneGroups& groups, AcceleratorCounts& counts) const override {
    for (const int first : groups)
      for (unsigned bits = bits_of(rays.t_max.at(first) > Lanes<T>(T(0))); bits != 0; bits &= bits - 1) {
        const int i = first + std::countr_zero(bits);
        into_.add({rays[i], rays.t_max[i]});
      }
    behind_.occlude(rays, groups, counts);
  }

 private:
  const Accelerator<T>& behind_;
  DecimatingSampler<T>& into_;
};

// Appends one sample per ray: the ray and its nearest hit. REQUIRES: `some` fits in a batch.
template <class T>
void find_occluders(const Accelerator<T>& accelerator, std::span<const ShadowRay<T>> some,
                    std::vector<OcclusionSample>& samples) {
  const auto rays = std::make_unique<RayBatch<T>>();
  const auto hits = std::make_unique<HitBatch<T>>();
  rays->count = static_cast<int>(some.size());
  for (int i = 0; i < kBatchRoom; ++i) {
    const bool real = i < rays->count;
    const ShadowRay<T>& ray = some[static_cast<std::size_t>(real ? i : 0)];
    rays->set(i, ray.ray, real ? ray.t_max : T(-1));
  }
  rays->time.values.fill(T(0.5));  // try_tiles() uses the same time
  hits->t = rays->t_max;
  hits->primitive.values.fill(kNoPrimitive);
  AcceleratorCounts counts;
  accelerator.closest(*rays, LaneGroups::covering(0, rays->count, kWidth<T>), *hits, counts);
  for (int i = 0; i < rays->count; ++i) {
    const Ray<T>& ray = some[static_cast<std::size_t>(i)].ray;
    samples.push_back({{Vec3d(ray.origin), Vec3d(ray.direction)}, static_cast<int>(hits->primitive[i])});
  }
}

}  // namespace

template <class T>
std::vector<OcclusionSample> sample_occlusion(const World<T>& world, const Plan& plan, std::stop_token stop) {
  DecimatingSampler<T> sampler;
  try_tiles<T>({world.geometry, std::make_shared<const Recorder<T>>(*world.accelerator, sampler)}, plan,
               kTiles, stop);
  const std::span<const ShadowRay<T>> rays = sampler.rays();
  std::vector<OcclusionSample> samples;
  for (std::size_t from = 0; from < rays.size(); from += kBatch)
    find_occluders(*world.accelerator, rays.subspan(from, std::min<std::size_t>(kBatch, rays.size() - from)),
                   samples);
  return samples;
}

template std::vector<OcclusionSample> sample_occlusion(const World<float>&, const Plan&, std::stop_token);
template std::vector<OcclusionSample> sample_occlusion(const World<double>&, const Plan&, std::stop_token);

}  // namespace orrery
