#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/math/lanes.h"

namespace orrery {

// A small network: two hidden layers whose negative sums count as 0, and a score for each of some answers.
struct Network {
  // Twice as many hidden ones proved a tenth more shadows for nearly three times the arithmetic.
  static constexpr std::size_t kInputs = 6, kHidden = 16, kAnswers = 16;
  template <class N>
  using Inputs = std::array<N, kInputs>;
  template <class N>
  using Hidden = std::array<N, kHidden>;
  template <class N>
  using Scores = std::array<N, kAnswers>;

  // Layer by layer: for each of its outputs the weights of its inputs, and then what is added.
  static constexpr std::size_t kSecond = kHidden * (kInputs + 1);
  static constexpr std::size_t kThird = kSecond + kHidden * (kHidden + 1);
  static constexpr std::size_t kWeights = kThird + kAnswers * (kHidden + 1);
  std::array<float, kWeights> weights{};

  // N: scalars or lanes. The same bits for each lane whatever the width.
  template <class N>
  void score(const Inputs<N>& in, Scores<N>& out) const {
    Hidden<N> first, second;
    score(in, first, second, out);
  }
  // With what the hidden layers make of it.
  template <class N>
  void score(const Inputs<N>& in, Hidden<N>& first, Hidden<N>& second, Scores<N>& out) const {
    sums(weights.data(), in, first);
    cut(first);
    sums(weights.data() + kSecond, first, second);
    cut(second);
    sums(weights.data() + kThird, second, out);
  }

  // What a layer makes of its inputs. Four at a time, so that additions need not wait for each other.
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
  Network::Inputs<float> in;  // about -1 to 1
  std::size_t answer;
};

struct TrainingOptions {
  int steps = 2000;    // four times as many proved a twentieth more shadows where many can be
  int examples = 32;   // of a step
  float rate = 3e-3f;  // of the first step; it falls in a straight line to a tenth
  std::uint32_t seed = 1;
};

// Random weights, as large as keep the sums about 1.
Network random_network(std::uint32_t seed);

// A network that has seen `steps` random lots of the examples (Adam: Kingma and Ba, 2014). One thread, a
// fixed order and IEEE operations alone: the same everywhere. REQUIRES: there are examples.
Network train_network(std::span<const NetworkExample> examples, const TrainingOptions& options = {});

}  // namespace orrery
