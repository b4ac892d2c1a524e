#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/batches.h"
#include "tests/support/scenes.h"

// Compares sampled directions of materials with their evaluation.
namespace orrery::test {
namespace {

// Batch of samples at one surface point for one view direction.
struct SampleBatch {
  RayBatch<double> rays;
  HitBatch<double> hits;
  SurfaceBatch<double> surface;
  Array<IndexOf<double>> slot;
  ScatterBatch<double> out;
  Vec3Array<double> pi_bsdf_cos;
  Array<double> pdf, reach;
  LaneGroups all = LaneGroups::covering(0, kBatch, kWidth<double>);

  SampleBatch(const Vec3d& direction, double side) {
    rays.count = kBatch;
    for (int i = 0; i < kBatchRoom; ++i) {
      rays.set(i, {Vec3d(0, 0, 1), direction}, 1);
      surface.normal.set(i, Vec3d(0, 0, 1));
      surface.geometric.set(i, Vec3d(0, 0, 1));
      surface.side[i] = side;
      surface.material[i] = 0;
      hits.t[i] = 0.5;
      surface.travelled[i] = 0.5;
      slot[i] = i % kBatch;
      reach[i] = 1;
      pdf[i] = 0;
    }
  }
};

MaterialKernelPtr<double> kernel_of(const char* material) {
  static std::shared_ptr<const Scene> scene;
  scene = load(scene_with(json("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1, 'material': 'it'}]"),
                          Json{{"materials", {{"white", nullptr}, {"it", json(material)}}}}));
  for (const auto& set : scene->materials)
    if (set->size() > 0) return set->kernel(double(), 0);
  return nullptr;
}

const Vec3d kSlanted = safe_normalize(Vec3d(0.6, 0.1, -0.7));

// The mean weight equals the albedo, which is integrated over the hemisphere. pi_bsdf_cos is pi times the
// BSDF times the cosine. The tolerance of 1.5 % is four standard deviations for the highlight.
TEST(RoughSampling, MeanWeightEqualsAlbedo) {
  const auto kernel = kernel_of("{'type': 'rough', 'kd': [0.5, 0.2, 0], 'ks': 0.4, 'shininess': 8}");
  const auto drawn = std::make_unique<SampleBatch>(kSlanted, 1.0);
  Vec3d sum;
  constexpr int kSamples = 64;
  for (int sample = 0; sample < kSamples; ++sample) {
    const Draws draws(1, TileView{0, 0, kTileSide, kTileSide}, sample);
    kernel->sample(drawn->rays, drawn->hits, drawn->surface, PathDraws<double>{draws, drawn->slot, 0},
                   drawn->all, Lobes::all, drawn->out);
    for (int i = 0; i < kBatch; ++i) sum = sum + drawn->out.weight[i];
  }
  const Vec3d mean = sum / (kBatch * kSamples);

  Vec3d albedo;
  constexpr int kSteps = 96;
  for (int a = 0; a < kSteps; ++a) {
    for (int i = 0; i < kSteps; ++i) {
      const double z = (a + 0.5) / kSteps, angle = 2 * std::numbers::pi * (i + 0.5) / kSteps;
      const double r = std::sqrt(1 - z * z);
      drawn->pi_bsdf_cos.set(i, Vec3d());
      drawn->rays.origin.set(i, {r * std::cos(angle), r * std::sin(angle), z});
    }
    kernel->evaluate({drawn->rays.direction, drawn->rays.origin, drawn->reach}, drawn->surface,
                     LaneGroups::covering(0, kSteps, kWidth<double>), Lobes::all, drawn->pi_bsdf_cos,
                     drawn->pdf);
    for (int i = 0; i < kSteps; ++i)
      if (drawn->pdf[i] > 0) albedo = albedo + drawn->pi_bsdf_cos[i] * (2.0 / (kSteps * kSteps));
  }
  EXPECT_NEAR(mean.x / albedo.x, 1, 0.015);
  EXPECT_NEAR(mean.y / albedo.y, 1, 0.015);
  EXPECT_NEAR(mean.z / albedo.z, 1, 0.015);
}

TEST(RoughSampling, MatchesDensityOfEvaluate) {
  const auto kernel = kernel_of("{'type': 'rough', 'kd': 0.5}");
  const auto drawn = std::make_unique<SampleBatch>(kSlanted, 1.0);
  const Draws draws(3, TileView{32, 64, kTileSide, kTileSide}, 5);
  kernel->sample(drawn->rays, drawn->hits, drawn->surface, PathDraws<double>{draws, drawn->slot, 2},
                 drawn->all, Lobes::all, drawn->out);
  kernel->evaluate({drawn->rays.direction, drawn->out.direction, drawn->reach}, drawn->surface, drawn->all,
                   Lobes::all, drawn->pi_bsdf_cos, drawn->pdf);
  double mean_cosine = 0;
  for (int i = 0; i < kBatch; ++i) {
    ASSERT_NEAR(length(drawn->out.direction[i]), 1, 1e-14);
    ASSERT_NEAR(drawn->out.pdf[i], drawn->pdf[i], 1e-15);
    mean_cosine += drawn->out.direction[i].z / kBatch;
  }
  EXPECT_NEAR(mean_cosine, 2.0 / 3, 0.01) << "mean cosine of a density proportional to the cosine";
}

// Glass without a filter absorbs no light, so each sample has weight 1. The fraction of mirrored samples
// equals the Fresnel reflectance.
TEST(RefractiveSampling, ReflectsInProportionToReflectance) {
  const auto kernel = kernel_of("{'type': 'refractive', 'ior': 1.5, 'fresnel': 'exact'}");
  const auto drawn = std::make_unique<SampleBatch>(safe_normalize(Vec3d(1, 0, -1)), 1.0);
  int mirrored = 0;
  constexpr int kSamples = 16;
  for (int sample = 0; sample < kSamples; ++sample) {
    const Draws draws(1, TileView{0, 0, kTileSide, kTileSide}, sample);
    kernel->sample(drawn->rays, drawn->hits, drawn->surface, PathDraws<double>{draws, drawn->slot, 0},
                   drawn->all, Lobes::all, drawn->out);
    for (int i = 0; i < kBatch; ++i) {
      ASSERT_EQ(drawn->out.weight[i], Vec3d(1));
      ASSERT_EQ(drawn->out.pdf[i], 0);
      mirrored += drawn->out.direction[i].z > 0;
    }
  }
  EXPECT_NEAR(static_cast<double>(mirrored) / (kBatch * kSamples), 0.0502399, 0.004);
}

TEST(ReflectiveSampling, ReturnsMirroredRay) {
  const auto kernel = kernel_of("{'type': 'reflective', 'n': [0.14, 0.16, 0.13], 'k': [4.1, 2.3, 3.1]}");
  const auto drawn = std::make_unique<SampleBatch>(kSlanted, 1.0);
  const Draws draws(1, TileView{0, 0, kTileSide, kTileSide}, 0);
  kernel->sample(drawn->rays, drawn->hits, drawn->surface, PathDraws<double>{draws, drawn->slot, 0},
                 drawn->all, Lobes::all, drawn->out);
  EXPECT_NEAR(length(drawn->out.direction[7] - Vec3d(kSlanted.x, kSlanted.y, -kSlanted.z)), 0, 1e-15);
  EXPECT_GT(drawn->out.weight[7].x, 0.9);
}

}  // namespace
}  // namespace orrery::test
