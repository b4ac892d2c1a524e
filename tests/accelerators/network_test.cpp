#include "core/occlusion/network.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/occlusion/network_predictor.h"
#include "tests/support/random.h"

// Tests inference and training of the network.
namespace orrery::test {
namespace {

constexpr std::size_t kInputs = Network::kInputs, kHidden = Network::kHidden, kAnswers = Network::kAnswers;

Network::Inputs<float> random_inputs(Random& random) {
  Network::Inputs<float> in;
  for (float& x : in) x = static_cast<float>(random.between(-1, 1));
  return in;
}

// Evaluates one dense layer. The weights are stored row by row, each row followed by its bias.
std::vector<double> layer(const float*& weight, const std::vector<double>& in, std::size_t outputs) {
  std::vector<double> out;
  for (std::size_t j = 0; j < outputs; ++j) {
    double sum = 0;
    for (const double x : in) sum += static_cast<double>(*weight++) * x;
    out.push_back(sum + static_cast<double>(*weight++));
  }
  return out;
}
void cut_negative(std::vector<double>& values) {
  for (double& value : values) value = std::max(0.0, value);
}

std::vector<double> plain_scores(const Network& network, const Network::Inputs<float>& in) {
  const float* weight = network.weights.data();
  std::vector<double> first = layer(weight, {in.begin(), in.end()}, kHidden);
  cut_negative(first);
  std::vector<double> second = layer(weight, first, kHidden);
  cut_negative(second);
  const std::vector<double> scores = layer(weight, second, kAnswers);
  EXPECT_EQ(weight, network.weights.data() + Network::kWeights);
  return scores;
}

// Returns a network with random weights. Their signs and magnitudes differ from those of an untrained
// network.
Network some_network(std::uint64_t seed) {
  Random random(seed);
  Network network;
  for (float& weight : network.weights) weight = static_cast<float>(random.between(-0.4, 0.4));
  return network;
}

template <class N>
class Scores : public testing::Test {};
using NumberTypes = testing::Types<float, double, Lanes<float>, Lanes<double>>;
TYPED_TEST_SUITE(Scores, NumberTypes);

TYPED_TEST(Scores, MatchesReferenceEvaluation) {
  using N = TypeParam;
  using T = ScalarOf<N>;
  Random random(2);
  constexpr int kLanes = static_cast<int>(sizeof(N) / sizeof(T));
  for (int round = 0; round < 50; ++round) {
    const Network network = some_network(static_cast<std::uint64_t>(round));
    std::array<Network::Inputs<float>, kLanes> cases;
    for (auto& in : cases) in = random_inputs(random);
    Network::Inputs<N> in;
    for (std::size_t i = 0; i < kInputs; ++i) {
      std::array<T, kLanes> lanes;
      for (std::size_t k = 0; k < kLanes; ++k) lanes[k] = static_cast<T>(cases[k][i]);
      std::memcpy(static_cast<void*>(&in[i]), lanes.data(), sizeof lanes);
    }
    Network::Scores<N> out;
    network.score(in, out);
    for (std::size_t k = 0; k < kLanes; ++k) {
      const std::vector<double> expected = plain_scores(network, cases[k]);
      for (std::size_t j = 0; j < kAnswers; ++j) {
        std::array<T, kLanes> lanes;
        std::memcpy(lanes.data(), &out[j], sizeof lanes);
        EXPECT_NEAR(static_cast<double>(lanes[k]), expected[j],
                    40 * static_cast<double>(std::numeric_limits<T>::epsilon()));
      }
    }
  }
}

// Returns examples labelled by boxes in input space. The labels are not linearly separable.
std::vector<NetworkExample> examples(int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<NetworkExample> examples;
  for (int i = 0; i < count; ++i) {
    NetworkExample example{random_inputs(random), 0};
    if (example.in[0] * example.in[1] > 0.1f) example.answer = example.in[2] > 0 ? 1 : 2;
    examples.push_back(example);
  }
  return examples;
}

// Returns the mean cross entropy of the scores over the examples, in nats.
double loss_of(const Network& network, const std::vector<NetworkExample>& of) {
  double loss = 0;
  for (const NetworkExample& example : of) {
    Network::Scores<float> scores;
    network.score(example.in, scores);
    double sum = 0;
    for (const float score : scores) sum += std::exp(double{score});
    loss += std::log(sum) - double{scores[example.answer]};
  }
  return loss / static_cast<double>(of.size());
}

double share_right(const Network& network, const std::vector<NetworkExample>& of) {
  int right = 0;
  for (const NetworkExample& example : of) {
    Network::Scores<float> scores;
    network.score(example.in, scores);
    const auto best = std::max_element(scores.begin(), scores.end()) - scores.begin();
    right += static_cast<std::size_t>(best) == example.answer;
  }
  return right / static_cast<double>(of.size());
}

TEST(Training, LowersLossOnUnseenExamples) {
  const auto seen = examples(4000, 1), unseen = examples(4000, 2);
  const Network before = random_network(1), after = train_network(seen);
  EXPECT_LT(loss_of(after, seen), 0.1 * loss_of(before, seen));
  EXPECT_LT(loss_of(after, unseen), 0.15 * loss_of(before, unseen));
  EXPECT_GT(share_right(after, unseen), 0.95);
}

TEST(Training, IsDeterministicForEqualSeeds) {
  const auto seen = examples(500, 3);
  TrainingOptions options{.steps = 200};
  const Network once = train_network(seen, options);
  EXPECT_EQ(once.weights, train_network(seen, options).weights);
  options.seed = 2;
  EXPECT_NE(once.weights, train_network(seen, options).weights);
}

// Shadow rays from a floor under two balls towards a light: the predictor learns which ball occludes each
// region.
TEST(NetworkPredictor, ProposesLearnedOccluders) {
  Random random(4);
  std::vector<OcclusionSample> samples;
  const auto occluder_at = [](double x) { return x < -0.5 ? 7 : x > 0.5 ? 3 : kNoPrimitive; };
  const auto origin = [&] { return Vec3d(random.between(-1, 1), 0, random.between(-1, 1)); };
  for (int i = 0; i < 3000; ++i) {
    const Vec3d at = origin();
    samples.push_back({{at, Vec3d(0, 1, 0)}, occluder_at(at.x)});
  }
  const auto predictor = network_predictor<float>(samples);
  const auto rays = std::make_unique<RayBatch<float>>();
  const auto proposed = std::make_unique<Array<IndexOf<float>>>();
  for (int i = 0; i < kBatch; ++i) {
    const Vec3d at = origin();
    rays->origin.x[i] = static_cast<float>(at.x);
    rays->origin.y[i] = 0;
    rays->origin.z[i] = static_cast<float>(at.z);
    rays->direction.x[i] = rays->direction.z[i] = 0;
    rays->direction.y[i] = rays->t_max[i] = 1;
  }
  predictor->propose(*rays, LaneGroups::covering(0, kBatch, kWidth<float>), *proposed);
  int right = 0;
  for (int i = 0; i < kBatch; ++i)
    right += (*proposed)[i] == occluder_at(static_cast<double>(rays->origin.x[i]));
  EXPECT_GT(right, kBatch * 9 / 10);
}

TEST(NetworkPredictor, ProposesNothingWithoutOccludedSamples) {
  const OcclusionSample lit{{{0, 0, 0}, {0, 1, 0}}, kNoPrimitive};
  const auto rays = std::make_unique<RayBatch<double>>();
  const auto proposed = std::make_unique<Array<IndexOf<double>>>();
  for (const auto& samples : {std::vector<OcclusionSample>{}, std::vector<OcclusionSample>{lit}}) {
    network_predictor<double>(samples)->propose(*rays, LaneGroups::single(0), *proposed);
    EXPECT_EQ((*proposed)[0], kNoPrimitive);
  }
}

}  // namespace
}  // namespace orrery::test
