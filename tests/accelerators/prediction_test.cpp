#include "core/occlusion/prediction.h"

#include "core/occlusion/network_predictor.h"
#include "tests/support/agreement.h"
#include "tests/support/covers.h"
#include "tests/support/mixtures.h"

// Tests that predictions never change shadows, whether they are right, wrong or not valid primitive numbers.
namespace orrery::test {
namespace {

// Kinds of invalid predictions.
enum class InvalidPrediction { out_of_range, always_wrong, any_number };

template <class T>
class Adversary final : public Predictor<T> {
 public:
  Adversary(InvalidPrediction kind, const PrimitiveList<T>& primitives)
      : kind_(kind), primitives_(primitives), count_(static_cast<IndexOf<T>>(primitives.size())) {}

  void propose(const RayBatch<T>& rays, const LaneGroups& groups,
               Array<IndexOf<T>>& primitive) const override {
    using Limits = std::numeric_limits<IndexOf<T>>;
    const std::array<IndexOf<T>, 6> beyond{Limits::min(), Limits::max(), -2,
                                           count_,        count_ + 1,    kNoPrimitive};
    Random random(static_cast<std::uint64_t>(groups.size() * 1000 + rays.count));
    for (const int group : groups) {
      const IndexOf<T> wrong = kind_ == InvalidPrediction::always_wrong ? missed(rays, group) : 0;
      for (int i = group; i < group + kWidth<T>; ++i) {
        if (kind_ == InvalidPrediction::always_wrong) primitive[i] = wrong;
        if (kind_ == InvalidPrediction::any_number)
          primitive[i] = random.below(2 * static_cast<int>(count_)) - count_ / 2;
        if (kind_ == InvalidPrediction::out_of_range)
          primitive[i] = beyond[static_cast<std::size_t>(random.below(6))];
      }
    }
  }

 private:
  // Returns a primitive that no ray of the lane group hits, or kNoPrimitive if every primitive is hit.
  IndexOf<T> missed(const RayBatch<T>& rays, int group) const {
    const LaneGroups one = LaneGroups::single(group);
    const auto tried = std::make_unique<RayBatch<T>>(rays);
    AcceleratorCounts counts;
    for (std::size_t p = 0; p < primitives_.size(); ++p) {
      tried->t_max = rays.t_max;
      primitives_[p].kernel->occlude(primitives_[p].index, *tried, one, counts);
      if (active_rays(*tried, one) == active_rays(rays, one)) return static_cast<IndexOf<T>>(p);
    }
    return kNoPrimitive;
  }

  InvalidPrediction kind_;
  const PrimitiveList<T>& primitives_;
  IndexOf<T> count_;
};

template <class T>
Stage<T> adversary(InvalidPrediction kind) {
  return [=](const auto& primitives, auto behind) {
    return predicted<T>(primitives, behind, std::make_shared<const Adversary<T>>(kind, primitives));
  };
}

// Returns a network predictor trained on the nearest hits of `rays`, which are later tested as shadow rays.
template <class T>
PredictorPtr<T> trained_on(const Json& scene, const Rays<T>& rays) {
  Structure<T> list(scene, "list");
  const auto hits = list.closest(rays);
  std::vector<OcclusionSample> samples;
  for (std::size_t i = 0; i < rays.size(); ++i)
    samples.push_back({convert_ray<double>(rays[i]), hits[i].primitive});
  return network_predictor<T>(samples);
}

template <class T>
struct Front {
  const char* name;
  Stage<T> stage;
};

template <class T>
std::vector<Front<T>> fronts(const Json& scene, const Rays<T>& rays) {
  const auto by = [](PredictorPtr<T> predictor) -> Stage<T> {
    return [=](const auto& primitives, auto behind) { return predicted<T>(primitives, behind, predictor); };
  };
  return {
      {"always wrong", adversary<T>(InvalidPrediction::always_wrong)},
      {"any number", adversary<T>(InvalidPrediction::any_number)},
      {"out of range", adversary<T>(InvalidPrediction::out_of_range)},
      {"random", by(random_predictor<T>(load(scene)->primitive_count()))},
      {"last", [](const auto& primitives, auto behind) { return predicted_by_last<T>(primitives, behind); }},
      {"network",
       by(trained_on<T>(
           scene, Rays<T>(rays.begin(), rays.begin() + std::min<std::ptrdiff_t>(2000, std::ssize(rays)))))}};
}

// Returns coherent rays from clusters of origins, in which consecutive rays often have the same occluder.
template <class T>
Rays<T> neighbouring_rays(int count, std::uint64_t seed) {
  Random random(seed);
  Rays<T> rays;
  while (static_cast<int>(rays.size()) < count) {
    const Vec3d at = random.in_cube(2.5), toward = random.direction();
    for (int i = 0; i < 256; ++i)
      rays.push_back(
          {Vec3<T>(at + random.in_cube(0.05)), Vec3<T>(safe_normalize(toward + random.direction() * 0.1))});
  }
  return rays;
}

struct Subject {
  const char* name;
  Json scene;
};
std::vector<Subject> subjects() {
  return {
      {"balls", balls(150, 1)}, {"mesh", wavy_sheet(12)}, {"mixture", mixture(2)}, {"planes", planes(5, 3)}};
}

// Expects the shadows of `count` rays to equal those of the list, with each predictor in front of the
// structure.
template <class T>
void expect_no_change(const Subject& subject, const std::string& accelerator, int count) {
  Rays<T> rays = neighbouring_rays<T>(count / 2, 4);
  const Rays<T> others = any_rays<T>(3, count / 2, 5);
  rays.insert(rays.end(), others.begin(), others.end());
  rays = subsample_rays(rays);
  Structure<T> reference(subject.scene, "list");
  for (const T reach : {T(0.8), std::numeric_limits<T>::infinity()}) {
    const std::vector<char> expected = reference.occluded(rays, reach);
    for (const auto& [front, stage] : fronts<T>(subject.scene, rays)) {
      Structure<T> structure(subject.scene, accelerator, stage);
      const std::vector<char> found = structure.occluded(rays, reach);
      int wrong = 0;
      for (std::size_t i = 0; i < rays.size(); ++i) wrong += found[i] != expected[i];
      EXPECT_EQ(wrong, 0) << subject.name << ", " << front << ", of " << rays.size();
    }
  }
}

class ShadowPrediction : public testing::TestWithParam<std::string> {};

TEST_P(ShadowPrediction, PreservesShadowsOfEveryStructure) {
  covers("F18");
  for (const Subject& subject : subjects()) {
    expect_no_change<float>(subject, GetParam(), 4'000);
    expect_no_change<double>(subject, GetParam(), 4'000);
  }
}

INSTANTIATE_TEST_SUITE_P(All, ShadowPrediction, testing::ValuesIn(accelerator_names()), parameter_name);

TEST(ShadowPrediction, PreservesShadowsOfManyRays) {  // a million in an exhaustive run
  covers("F18");
  const int rays = exhaustive() ? 1'000'000 : 20'000;
  for (const Subject& subject : subjects()) {
    expect_no_change<float>(subject, "bvh", rays);
    expect_no_change<double>(subject, "bvh", rays);
  }
}

// Components of these rays are NaN, infinite, zero, denormal or the largest numbers.
TEST(ShadowPrediction, PreservesShadowsOfInvalidRays) {
  covers("F18");
  const Subject subject{"balls", balls(50, 1)};
  const Rays<float> rays = invalid_rays<float>(10'000, 6);
  Structure<float> reference(subject.scene, "list");
  const std::vector<char> expected = reference.occluded(rays, 2);
  for (const auto& [front, stage] : fronts<float>(subject.scene, any_rays<float>(3, 2000, 5)))
    EXPECT_EQ(Structure<float>(subject.scene, "bvh", stage).occluded(rays, 2), expected) << front;
}

TEST(ShadowPrediction, MakesNoPredictionsForNearestHitQueries) {
  const Json scene = balls(50, 1);
  const Rays<float> rays = any_rays<float>(3, 5'000, 5);
  Structure<float> reference(scene, "list");
  for (const auto& [front, stage] : fronts<float>(scene, rays)) {
    Structure<float> structure(scene, "bvh", stage);
    SCOPED_TRACE(front);
    expect_agreement<float>(structure, reference, rays, {});
    EXPECT_EQ(structure.counts().predicted_occluders, 0u);
  }
}

TEST(PredictionCounts, CountsPredictedAndVerifiedOccludersSeparately) {
  const Json scene = balls(150, 1);
  const Rays<float> rays = any_rays<float>(3, 1000, 5);
  const auto counts = [&](const Stage<float>& stage) {
    Structure<float> structure(scene, "list", stage);
    structure.occluded(rays, std::numeric_limits<float>::infinity());
    return structure.counts();
  };
  const AcceleratorCounts bare = counts({}),
                          nothing = counts(adversary<float>(InvalidPrediction::out_of_range)),
                          wrong = counts(adversary<float>(InvalidPrediction::always_wrong));
  EXPECT_EQ(nothing.predicted_occluders, 0u);
  EXPECT_EQ(nothing.primitive_tests, bare.primitive_tests);
  EXPECT_EQ(wrong.predicted_occluders, 1000u);
  EXPECT_EQ(wrong.verified_occluders, 0u);
  EXPECT_EQ(wrong.primitive_tests, bare.primitive_tests + 1000);
}

TEST(PredictionCounts, LastOccluderSavesTestsForCoherentRays) {
  const Json scene = balls(150, 1);
  const Rays<float> rays = neighbouring_rays<float>(20'000, 4);
  Structure<float> bare(scene, "list"), last(scene, "list", [](const auto&primitives, auto behind) {
    return predicted_by_last<float>(primitives, behind);
  });
  bare.occluded(rays, 2);
  last.occluded(rays, 2);
  EXPECT_GT(last.counts().verified_occluders, 1000u);
  EXPECT_LT(last.counts().primitive_tests, bare.counts().primitive_tests);
}

}  // namespace
}  // namespace orrery::test
