#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/bounds.h"
#include "core/model/light.h"
#include "core/model/record.h"

namespace orrery {

// A light, or a cluster of lights, as it is weighed against others: see LightBounds.
template <class N>
struct LightCluster {
  Vec3<N> centre, axis;
  N radius, spread;  // sine of the angle by which normals differ from the axis or its opposite; 1: no matter
  N strength, c0, c1, c2;

  // What arrives, times a bound on the cosine under which anything of the cluster is seen: sines of the cone
  // of normals and of the sphere about the centre are added to that of the axis.
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

// Which light to draw at a point: in proportion to what reaches it, roughly, by position alone. A node weighs
// up to 16 members, lights or clusters of lights with a node of their own: up to 16 lights are weighed one by
// one (Conty and Kulla, "Importance Sampling of Many Lights with Adaptive Tree Splitting", HPG 2018). Built
// in double precision, with ties in the order of the lights. Const: any number of threads may ask it.
template <class T>
class LightTree {
 public:
  static constexpr std::size_t kMembers = 16;

  // REQUIRES: at least one light.
  explicit LightTree(std::span<const LightBounds> lights);

  std::size_t size() const { return path_of_.size(); }

  static constexpr auto kPoints = static_cast<std::size_t>(kWidth<T>);
  struct Choices {
    std::array<std::size_t, kPoints> light;
    std::array<T, kPoints> probability;
  };
  // The lights that numbers in [0, 1) choose at the points of a register.
  Choices choose(const Vec3<Lanes<T>>& positions, const std::array<double, kPoints>& u) const;
  // The probability with which that chooses a light at a point: the same bits.
  T probability(const Vec3<T>& position, std::size_t light) const;

 private:
  static constexpr std::size_t kNumbers = kFields<LightCluster, T>;
  struct alignas(64) Node {
    std::array<std::array<T, kMembers>, kNumbers> numbers;  // of LightCluster, each of all members
    std::array<std::int32_t, kMembers> target;              // a node; ~number of a light
    std::size_t count = 0;
  };
  struct alignas(64) Weights : std::array<T, kMembers> {};
  struct Builder;
  struct Descent;

  // Weights of a node's members at a point, and their sum.
  static double weigh(const Node& node, const Vec3<T>& position, Weights& weights);
  static double sum_of(const Node& node, Weights& weights);

  std::vector<Node> nodes_;             // the root first
  std::vector<std::uint64_t> path_of_;  // of each light: its member of each node, 4 bits a level, root lowest
};

extern template class LightTree<float>;
extern template class LightTree<double>;

}  // namespace orrery
