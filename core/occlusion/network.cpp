#include "core/occlusion/network.h"

#include <algorithm>
#include <cmath>

#include "core/math/elementary.h"
#include "core/math/sampling.h"

namespace orrery {
namespace {

using Weights = std::array<float, Network::kWeights>;
using Hidden = Network::Hidden<float>;
using Scores = Network::Scores<float>;

constexpr float kLog2E = 1.44269504f;

// Activations of a network for one example.
struct Activations {
  Hidden first, second;
  Scores share;  // probability of each answer

  Activations(const Network& network, const Network::Inputs<float>& in) {
    network.score(in, first, second, share);
    const float largest = *std::max_element(share.begin(), share.end());
    float sum = 0;
    for (float& s : share) sum += s = exp2_flushed((s - largest) * kLog2E);
    for (float& s : share) s /= sum;
  }
};

// Backpropagates through the layer at `row`: adds the gradient of its weights to `slope` and sets the
// gradient of its inputs. An input of 0 was clipped by ReLU, so its gradient is 0.
template <std::size_t kIn, std::size_t kOut>
void add_slope(const float* row, const std::array<float, kIn>& in, const std::array<float, kOut>& of_out,
               float* slope, std::array<float, kIn>* of_in) {
  std::array<float, kIn> passed{};
  for (std::size_t j = 0; j < kOut; ++j, row += kIn + 1, slope += kIn + 1) {
    for (std::size_t i = 0; i < kIn; ++i) {
      slope[i] += of_out[j] * in[i];
      passed[i] += of_out[j] * row[i];
    }
    slope[kIn] += of_out[j];
  }
  if (!of_in) return;
  for (std::size_t i = 0; i < kIn; ++i) (*of_in)[i] = in[i] > 0 ? passed[i] : 0.0f;
}

void add_slope(const Network& network, const NetworkExample& example, Weights& slope) {
  const Activations thought(network, example.in);
  Scores of_score = thought.share;
  of_score[example.answer] -= 1;
  Hidden of_second, of_first;
  const float* const weights = network.weights.data();
  add_slope(weights + Network::kThird, thought.second, of_score, slope.data() + Network::kThird, &of_second);
  add_slope(weights + Network::kSecond, thought.first, of_second, slope.data() + Network::kSecond, &of_first);
  add_slope<Network::kInputs>(weights, example.in, of_first, slope.data(), nullptr);
}

// Adam optimizer: running means of the gradient and of its square, with bias correction.
class Adam {
 public:
  void step(Network& network, const Weights& slope, float rate) {
    constexpr float kKeep = 0.9f, kKeepSquare = 0.999f, kLeast = 1e-8f;
    left_ *= kKeep;
    left_square_ *= kKeepSquare;
    const float of_mean = 1 / (1 - left_), of_square = 1 / (1 - left_square_);
    for (std::size_t i = 0; i < Network::kWeights; ++i) {
      mean_[i] = kKeep * mean_[i] + (1 - kKeep) * slope[i];
      square_[i] = kKeepSquare * square_[i] + (1 - kKeepSquare) * slope[i] * slope[i];
      network.weights[i] -= rate * (mean_[i] * of_mean) / (std::sqrt(square_[i] * of_square) + kLeast);
    }
  }

 private:
  Weights mean_{}, square_{};
  float left_ = 1, left_square_ = 1;
};

}  // namespace

Network random_network(std::uint32_t seed) {
  Network network;
  const auto fill = [&](std::size_t from, std::size_t to, std::size_t inputs) {
    const float reach = std::sqrt(6 / static_cast<float>(inputs));  // He et al., 2015
    for (std::size_t i = from; i < to; ++i) {
      const bool added = (i - from) % (inputs + 1) == inputs;
      const float unit = unit_float(combine_bits(seed, static_cast<std::uint32_t>(i)));
      network.weights[i] = added ? 0.0f : reach * (2 * unit - 1);
    }
  };
  fill(0, Network::kSecond, Network::kInputs);
  fill(Network::kSecond, Network::kThird, Network::kHidden);
  fill(Network::kThird, Network::kWeights, Network::kHidden);
  return network;
}

Network train_network(std::span<const NetworkExample> examples, const TrainingOptions& options) {
  Network network = random_network(options.seed);
  Adam adam;
  std::uint32_t drawn = 0;
  for (int step = 0; step < options.steps; ++step) {
    Weights slope{};
    for (int i = 0; i < options.examples; ++i) {
      const std::uint64_t bits = combine_bits(~options.seed, drawn++);
      add_slope(network, examples[bits * examples.size() >> 32], slope);
    }
    for (float& s : slope) s /= static_cast<float>(options.examples);
    const float done = static_cast<float>(step) / static_cast<float>(options.steps);
    adam.step(network, slope, options.rate * (1 - 0.9f * done));
  }
  return network;
}

}  // namespace orrery
