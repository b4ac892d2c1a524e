#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/bounds.h"
#include "core/model/light.h"
#include "core/model/record.h"

namespace orrery {

// Light or cluster of lights, with the values that determine the importance: see LightBounds.
template <class N>
struct LightCluster {
  Vec3<N> centre, axis;
  N radius;
  N spread;  // sine of the largest angle between the axis and a normal or its opposite; 1: any angle
  N strength, c0, c1, c2;

  // Returns an estimate of the light received at `position`: strength over attenuation, times an upper bound
  // on the cosine at the lights. The bound is the cosine to the axis, plus the sine of the spread of the
  // normals, plus the sine of the angular radius of the bounding sphere.
  N importance(const Vec3<N>& position) const {
    using std::abs;
    using T = ScalarOf<N>;
    const N one(T(1));
    const Vec3<N> line = position - centre;
    const N distance = length(line);
    const N arriving = strength * min_first(one, N(one / (c0 + distance * (c1 + distance * c2))));
    return arriving * min_first(one, N((abs(dot(axis, line)) + radius) / distance + spread));
  }
};

// Selects a light for a point, with a probability roughly proportional to the light received there. A node
// has up to 16 members: lights, or clusters with child nodes. A tree of up to 16 lights therefore has a
// single node, in which each light has its own weight (Conty and Kulla, "Importance Sampling of Many Lights
// with Adaptive Tree Splitting", HPG 2018). The tree is built in double precision. Equal lights keep their
// order. Immutable and thread-safe.
template <class T>
class LightTree {
 public:
  static constexpr std::size_t kMembers = 16;

  // Builds the tree. Throws Cancelled. REQUIRES: at least one light.
  explicit LightTree(std::span<const LightBounds> lights);

  std::size_t size() const { return path_of_.size(); }

  static constexpr auto kPoints = static_cast<std::size_t>(kWidth<T>);
  struct Choices {
    std::array<std::size_t, kPoints> light;
    std::array<T, kPoints> probability;
  };
  // Selects a light for each position of a register by random numbers u in [0, 1).
  Choices choose(const Vec3<Lanes<T>>& positions, const std::array<double, kPoints>& u) const;
  // Returns the probability with which choose() selects a light at a position. Equals Choices::probability
  // bit for bit.
  T probability(const Vec3<T>& position, std::size_t light) const;

 private:
  static constexpr std::size_t kNumbers = kFields<LightCluster, T>;
  struct alignas(64) Node {
    std::array<std::array<T, kMembers>, kNumbers> numbers;  // fields of LightCluster, for all members
    std::array<std::int32_t, kMembers> target;              // index of a node, or ~number of a light
    std::size_t count = 0;
  };
  struct alignas(64) Weights : std::array<T, kMembers> {};
  struct Builder;
  struct Descent;

  // Computes the weights of a node's members at a point and returns their sum.
  static double weigh(const Node& node, const Vec3<T>& position, Weights& weights);
  static double sum_of(const Node& node, Weights& weights);

  std::vector<Node> nodes_;             // root first
  std::vector<std::uint64_t> path_of_;  // by light: member on the path, 4 bits per level from the root
};

extern template class LightTree<float>;
extern template class LightTree<double>;

}  // namespace orrery
