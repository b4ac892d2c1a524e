#include <algorithm>

#include "tests/support/agreement.h"
#include "tests/support/batches.h"
#include "tests/support/covers.h"
#include "tests/support/mixtures.h"

// Tests nearest-hit queries of rays that already have a hit. A structure replaces the hit only by a nearer
// hit, or by an equally near hit with a lower primitive number.
namespace orrery::test {
namespace {

// Returns the hit of each ray with `primitive`, found by the primitive's kernel.
template <class T>
std::vector<Hit<T>> hits_of(const Primitive<T>& primitive, const Rays<T>& rays) {
  std::vector<Hit<T>> found;
  AcceleratorCounts counts;
  const auto batch = std::make_unique<RayBatch<T>>();
  const auto hits = std::make_unique<HitBatch<T>>();
  for_each_batch<T>(rays, [&](std::span<const Ray<T>> some, std::size_t) {
    fill_batch(some, std::numeric_limits<T>::infinity(), *batch);
    hits->t = batch->t_max;
    hits->primitive.values.fill(kNoPrimitive);
    primitive.kernel->closest(primitive.index, *batch, groups_of(*batch), *hits, counts);
    for (int i = 0; i < batch->count; ++i)
      found.push_back({hits->t[i], static_cast<int>(hits->primitive[i])});
  });
  return found;
}

// Initial hits, one per ray. `any`: the hit with a random primitive, if any. `last`: the hit with the
// highest-numbered primitive at the nearest distance.
template <class T>
struct StartingHits {
  std::vector<Hit<T>> any, last;

  StartingHits(const PrimitiveList<T>& primitives, const Rays<T>& rays, const std::vector<Hit<T>>& nearest)
      : any(rays.size()), last(rays.size()) {
    Random random(1);
    std::vector<int> chosen;
    for (std::size_t i = 0; i < rays.size(); ++i)
      chosen.push_back(random.below(static_cast<int>(primitives.size())));
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      const std::vector<Hit<T>> hits = hits_of(primitives[p], rays);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        if (chosen[i] == static_cast<int>(p)) any[i] = hits[i];
        if (hits[i].met() && hits[i].t == nearest[i].t) last[i] = hits[i];
      }
    }
  }
};

// Returns the scene with every object three times, so that every hit is a tie.
Json doubled(Json scene) {
  const Json objects = scene["objects"];
  for (int i = 0; i < 2; ++i)
    for (const Json& object : objects) scene["objects"].push_back(object);
  return scene;
}

class KnownHits : public testing::TestWithParam<std::string> {
 protected:
  template <class T>
  void agree(const Json& scene, const Rays<T>& rays) {
    Structure<T> list(scene, "list"), structure(scene, GetParam());
    const std::vector<Hit<T>> nearest = list.closest(rays);
    EXPECT_EQ(wrong<T>(structure.closest(rays, nearest), nearest), 0) << "the initial hit is the nearest";
    const StartingHits<T> known(list.geometry().primitives, rays, nearest);
    for (const auto& hits : {known.any, known.last}) {
      EXPECT_EQ(wrong<T>(structure.closest(rays, hits), nearest), 0);
      EXPECT_EQ(wrong<T>(list.closest(rays, hits), nearest), 0);
    }
  }
  template <class T>
  void agree_on_all() {
    for (const Json& scene : {balls(60, 1), doubled(balls(60, 1)), wavy_sheet(8), doubled(mixture(1)),
                              planes(5, 2), doubled(planes(5, 2))})
      for (const double half : {3.0, 1000.0}) {
        Rays<T> rays = any_rays<T>(half, 3000, 3);
        for (Ray<T>& ray : rays)  // most rays from afar would miss
          if (half > 3) ray.direction = Vec3<T>(safe_normalize(Vec3d(-ray.origin)));
        agree<T>(scene, subsample_rays(rays));
      }
  }

 private:
  template <class T>
  static int wrong(const std::vector<Hit<T>>& found, const std::vector<Hit<T>>& expected) {
    int wrong = 0;
    for (std::size_t i = 0; i < found.size(); ++i)
      wrong += found[i].primitive != expected[i].primitive || found[i].t != expected[i].t;
    return wrong;
  }
};

TEST_P(KnownHits, ReplacesHitOnlyByNearerOrLowerNumberedHit) {
  covers("F1");
  agree_on_all<float>();
  agree_on_all<double>();
}

INSTANTIATE_TEST_SUITE_P(All, KnownHits, testing::ValuesIn(accelerator_names()), parameter_name);

}  // namespace
}  // namespace orrery::test
