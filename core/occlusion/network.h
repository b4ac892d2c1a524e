#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/math/lanes.h"

namespace orrery {

// Small neural network: two hidden layers with ReLU, and one score per answer. Scores are log-odds: the
// difference of two scores is the logarithm of the ratio of the probabilities of the answers.
struct Network {
  // With 32 hidden units, 10 % more shadow rays are proved occluded, for nearly three times the arithmetic.
  static constexpr std::size_t kInputs = 6, kHidden = 16, kAnswers = 16;
  template <class N>
  using Inputs = std::array<N, kInputs>;
  template <class N>
  using Hidden = std::array<N, kHidden>;
  template <class N>
  using Scores = std::array<N, kAnswers>;

  // Offsets of the layers in `weights`. For each output of a layer, the weights of the inputs are stored,
  // followed by the bias.
  static constexpr std::size_t kSecond = kHidden * (kInputs + 1);
  static constexpr std::size_t kThird = kSecond + kHidden * (kHidden + 1);
  static constexpr std::size_t kWeights = kThird + kAnswers * (kHidden + 1);
  std::array<float, kWeights> weights{};

  // Computes the scores. N is a scalar or lanes. Results are bit-identical for any number of lanes.
  template <class N>
  void score(const Inputs<N>& in, Scores<N>& out) const {
    Hidden<N> first, second;
    score(in, first, second, out);
  }
  // Computes the scores and the activations of the hidden layers.
  template <class N>
  void score(const Inputs<N>& in, Hidden<N>& first, Hidden<N>& second, Scores<N>& out) const {
    sums(weights.data(), in, first);
    cut(first);
    sums(weights.data() + kSecond, first, second);
    cut(second);
    sums(weights.data() + kThird, second, out);
  }

  // Computes the weighted sums of a layer, four outputs at a time to hide the latency of additions.
  template <class N, std::size_t kIn, std::size_t kOut>
  [[gnu::always_inline]] static void sums(const float* row, const std::array<N, kIn>& in,
                                          std::array<N, kOut>& out) {
    static_assert(kOut % 4 == 0);
    const auto weight = [](float w) { return N(static_cast<ScalarOf<N>>(w)); };
    constexpr std::size_t kRow = kIn + 1;
    for (std::size_t j = 0; j < kOut; j += 4, row += 4 * kRow) {
      N a = weight(row[kIn]), b = weight(row[kRow + kIn]), c = weight(row[2 * kRow + kIn]),
        d = weight(row[3 * kRow + kIn]);
      for (std::size_t i = 0; i < kIn; ++i) {
        a = a + in[i] * weight(row[i]);
        b = b + in[i] * weight(row[kRow + i]);
        c = c + in[i] * weight(row[2 * kRow + i]);
        d = d + in[i] * weight(row[3 * kRow + i]);
      }
      out[j] = a;
      out[j + 1] = b;
      out[j + 2] = c;
      out[j + 3] = d;
    }
  }
  template <class N, std::size_t kCount>
  [[gnu::always_inline]] static void cut(std::array<N, kCount>& sums) {
    for (N& sum : sums) sum = max_first(N(ScalarOf<N>(0)), sum);
  }
};

struct NetworkExample {
  Network::Inputs<float> in;  // each from about -1 to 1
  std::size_t answer;
};

struct TrainingOptions {
  // With 8,000 steps, 5 % more shadow rays are proved occluded in scenes with many occluded rays.
  int steps = 2000;
  int examples = 32;   // per step
  float rate = 3e-3f;  // learning rate of the first step; falls linearly to a tenth
  std::uint32_t seed = 1;
};

// Returns random weights with which activations keep their scale from layer to layer (He et al., 2015).
Network random_network(std::uint32_t seed);

// Trains a network with options.steps random batches of the examples (Adam: Kingma and Ba, 2014). Uses one
// thread, a fixed order and IEEE operations only, so results are the same on every machine. REQUIRES: at
// least one example.
Network train_network(std::span<const NetworkExample> examples, const TrainingOptions& options = {});

}  // namespace orrery
