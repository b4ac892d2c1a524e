#include "core/lighting/light_tree.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <tuple>

#include "core/base/prefetch.h"
#include "core/base/task_scope.h"

namespace orrery {
namespace {

using Numbers = std::span<std::int32_t>;  // numbers of lights, ascending

LightCluster<double> cluster_of(const LightBounds& light) {
  const bool flat = light.normal != Vec3d(0);
  const auto& [c0, c1, c2] = light.attenuation;
  return {light.centre, light.normal, light.radius, flat ? 0.0 : 1.0, light.strength, c0, c1, c2};
}

// Returns `normal` or its opposite, whichever is closer to `axis`.
Vec3d aligned(const Vec3d& normal, const Vec3d& axis) { return dot(normal, axis) < 0 ? -normal : normal; }

// Quantities that determine the cost of a group of lights in the tree.
struct Extent {
  Boundsd box;
  double energy = 0;
  Vec3d axis;  // sum of normals, each flipped to the side of the preceding sum
  int count = 0;

  void include(const Extent& other) {
    box.include(other.box);
    energy += other.energy;
    axis = axis + aligned(other.axis, axis);
    count += other.count;
  }
  // Returns energy times squared diagonal times a factor for the spread of the normals, from 1 for equal
  // normals to 3. The spread is estimated as if the normals filled a spherical cap uniformly. The mean normal
  // of a cap has the length (1 + cosine of the half angle) / 2.
  double cost() const {
    if (count == 0) return 0;
    const Vec3d across = box.hi - box.lo;
    const double cosine = std::max(0.0, 2 * length(axis) / count - 1);
    return energy * dot(across, across) * (3 - 2 * cosine);
  }
};

// Determines where the tree builder splits a group of lights.
class SplitPolicy {
 public:
  explicit SplitPolicy(std::span<const LightBounds> lights) : lights_(lights) {
    Boundsd all;
    for (const LightBounds& light : lights)
      if (!light.parallel) all.include(Boundsd::around(light.centre, Vec3d(light.radius)));
    scale_ = lights.empty() || !all.bounded() ? 0 : all.diagonal();
  }

  Extent extent_of(std::int32_t number) const {
    const LightBounds& light = lights_[static_cast<std::size_t>(number)];
    const auto& [c0, c1, c2] = light.attenuation;
    const double arriving = std::min(1.0, 1 / (c0 + scale_ * (c1 + scale_ * c2)));
    return {Boundsd::around(light.centre, Vec3d(light.radius)), light.strength * arriving, light.normal, 1};
  }
  Extent extent_of(Numbers numbers) const {
    Extent all;
    for (const std::int32_t number : numbers) all.include(extent_of(number));
    return all;
  }

  // Reorders the lights into two parts and returns the size of the first. If only some lights are at infinite
  // distance, these lights form the first part. Lights at finite distance are split at the plane between two
  // bins with the lowest cost. The cost of a plane is the total cost of both parts, times the ratio of the
  // longest extent to the extent along the axis. If there is no plane, the parts have equal size. REQUIRES:
  // at least two lights.
  std::size_t split(Numbers numbers) const {
    const auto parallel = [this](std::int32_t n) { return lights_[static_cast<std::size_t>(n)].parallel; };
    const auto near = std::stable_partition(numbers.begin(), numbers.end(), parallel);
    if (near == numbers.end()) return numbers.size() / 2;
    if (near != numbers.begin()) return static_cast<std::size_t>(near - numbers.begin());
    Boundsd centres;
    for (const std::int32_t n : numbers) centres.include(lights_[static_cast<std::size_t>(n)].centre);
    Plane best;
    for (std::size_t axis = 0; axis < 3; ++axis) best_plane(numbers, centres, axis, best);
    if (best.bin < 0) return numbers.size() / 2;
    const auto before = [&](std::int32_t n) { return bin_of(n, centres, best.axis) <= best.bin; };
    return static_cast<std::size_t>(std::stable_partition(numbers.begin(), numbers.end(), before) -
                                    numbers.begin());
  }

 private:
  static constexpr int kBins = 12;
  struct Plane {
    double cost = std::numeric_limits<double>::infinity();
    std::size_t axis = 0;
    int bin = -1;  // last bin before the plane
  };

  int bin_of(std::int32_t number, const Boundsd& centres, std::size_t axis) const {
    const double lo = centres.lo[axis], hi = centres.hi[axis];
    const double at = (lights_[static_cast<std::size_t>(number)].centre[axis] - lo) / (hi - lo);
    return std::min(kBins - 1, static_cast<int>(at * kBins));
  }

  void best_plane(Numbers numbers, const Boundsd& centres, std::size_t axis, Plane& best) const {
    const Vec3d across = centres.hi - centres.lo;
    if (!(across[axis] > 0 && std::isfinite(across[axis]))) return;
    std::array<Extent, kBins> bins, after;
    for (const std::int32_t n : numbers)
      bins[static_cast<std::size_t>(bin_of(n, centres, axis))].include(extent_of(n));
    Extent side;
    for (std::size_t bin = kBins; bin-- > 0;) {
      side.include(bins[bin]);
      after[bin] = side;
    }
    side = {};
    for (std::size_t bin = 0; bin + 1 < kBins; ++bin) {
      side.include(bins[bin]);
      if (side.count == 0 || after[bin + 1].count == 0) continue;
      const double cost = (side.cost() + after[bin + 1].cost()) * (max_component(across) / across[axis]);
      if (cost < best.cost) best = {cost, axis, static_cast<int>(bin)};
    }
  }

  std::span<const LightBounds> lights_;
  double scale_;  // distance in metres at which the energies of lights are compared
};

}  // namespace

template <class T>
struct LightTree<T>::Builder {
  LightTree& tree;
  std::span<const LightBounds> lights;
  SplitPolicy split_policy{lights};

  // From this level on, groups are split into halves of equal count, so that any tree has at most 16 levels.
  // A path stores 4 bits per level.
  static constexpr int kLevels = 8;

  struct Group {
    Numbers numbers;
    double cost;
  };

  // Merges lights into a cluster. At any distance, the attenuation is at least the attenuation at the radius
  // of the bounding sphere. Harmonic means of the attenuation coefficients preserve the total light that
  // arrives far away.
  LightCluster<double> cluster(Numbers numbers) const {
    Boundsd box;
    Vec3d axis, reach;  // reach: sums of strength / coefficient
    LightCluster<double> all{};
    for (const std::int32_t n : numbers) {
      const LightBounds& light = lights[static_cast<std::size_t>(n)];
      box.include(Boundsd::around(light.centre, Vec3d(light.radius)));
      axis = axis + aligned(light.normal, axis);
      if (!(light.strength > 0)) continue;
      all.strength += light.strength;
      const auto& [c0, c1, c2] = light.attenuation;
      reach = reach + Vec3d(light.strength / c0, light.strength / c1, light.strength / c2);
    }
    all.centre = (box.lo + box.hi) * 0.5;
    all.axis = safe_normalize(axis);
    double cosine = 1;
    for (const std::int32_t n : numbers) {
      const LightBounds& light = lights[static_cast<std::size_t>(n)];
      all.radius = std::max(all.radius, length(light.centre - all.centre) + light.radius);
      cosine = std::min(cosine, std::abs(dot(light.normal, all.axis)));
    }
    all.spread = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    if (!(all.strength > 0)) reach = Vec3d(1);
    all.c1 = all.strength / reach.y;
    all.c2 = all.strength / reach.z;
    all.c0 = all.strength / reach.x + all.radius * (all.c1 + all.radius * all.c2);
    return all;
  }

  std::vector<Group> groups_of(Numbers numbers, int level) const {
    std::vector<Group> groups{{numbers, 0}};
    const auto weight = [&](const Group& group) {
      const bool whole = group.numbers.size() == 1;
      return std::tuple(!whole, whole || level >= kLevels ? 0 : group.cost, group.numbers.size());
    };
    while (groups.size() < kMembers) {
      const auto largest =
          std::max_element(groups.begin(), groups.end(),
                           [&](const Group& a, const Group& b) { return weight(a) < weight(b); });
      const Numbers both = largest->numbers;
      if (both.size() == 1) break;
      const std::size_t first = level < kLevels ? split_policy.split(both) : both.size() / 2;
      const Numbers left = both.first(first), right = both.subspan(first);
      *largest = {left, split_policy.extent_of(left).cost()};
      groups.insert(largest + 1, {right, split_policy.extent_of(right).cost()});
    }
    return groups;
  }

  std::int32_t add_node(Numbers numbers, int level, std::uint64_t path) {
    const auto place = tree.nodes_.size();
    checkpoint(place);
    tree.nodes_.emplace_back();
    Node node{};
    for (const Group& group : groups_of(numbers, level)) {
      const std::uint64_t here = path | static_cast<std::uint64_t>(node.count) << (4 * level);
      LightCluster<double> member;
      if (const std::int32_t light = group.numbers.front(); group.numbers.size() == 1) {
        member = cluster_of(lights[static_cast<std::size_t>(light)]);
        node.target[node.count] = ~light;
        tree.path_of_[static_cast<std::size_t>(light)] = here;
      } else {
        member = cluster(group.numbers);
        node.target[node.count] = add_node(group.numbers, level + 1, here);
      }
      const auto converted = convert_record<LightCluster, T, double>(member);
      std::array<T, kNumbers> row;
      std::memcpy(row.data(), &converted, sizeof row);
      for (std::size_t i = 0; i < kNumbers; ++i) node.numbers[i][node.count] = row[i];
      ++node.count;
    }
    tree.nodes_[place] = node;
    return static_cast<std::int32_t>(place);
  }
};

// Traversal of the tree from the root to a light, which consumes one random number.
template <class T>
struct LightTree<T>::Descent {
  double u = 0;
  double probability = 1;

  // Returns the target of the member selected by u, and rescales u. The loop ends at a member because u < 1
  // implies u * sum < sum.
  std::int32_t step(const Node& node, const Weights& weights, double sum) {
    constexpr double kBelowOne = 1 - std::numeric_limits<double>::epsilon() / 2;
    const double wanted = u * sum;
    double before = 0;
    std::size_t chosen = 0;
    for (double end = double{weights[0]}; end <= wanted; end += double{weights[++chosen]}) before = end;
    const double weight{weights[chosen]};
    u = std::min(kBelowOne, (wanted - before) / weight);
    probability *= weight / sum;
    return node.target[chosen];
  }
};

template <class T>
LightTree<T>::LightTree(std::span<const LightBounds> lights) : path_of_(lights.size()) {
  std::vector<std::int32_t> numbers(lights.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  Builder{*this, lights}.add_node(numbers, 0, 0);
}

// Returns the sum of the weights. Sets all weights to 1 if their sum is 0 or not finite.
template <class T>
double LightTree<T>::sum_of(const Node& node, Weights& weights) {
  double sum = 0;
  for (std::size_t i = 0; i < node.count; ++i) sum += double{weights[i]};
  if (sum > 0 && sum < std::numeric_limits<double>::infinity()) return sum;
  std::fill_n(weights.begin(), node.count, T(1));
  return static_cast<double>(node.count);
}

// Weighs the members of a node for one point, with members as lanes.
template <class T>
double LightTree<T>::weigh(const Node& node, const Vec3<T>& position, Weights& weights) {
  using N = Lanes<T>;
  const Vec3<N> at{N(position.x), N(position.y), N(position.z)};
  for (std::size_t i = 0; i < node.count; i += static_cast<std::size_t>(kWidth<T>)) {
    std::array<N, kNumbers> lanes;
    for (std::size_t k = 0; k < kNumbers; ++k) lanes[k] = load(&node.numbers[k][i]);
    LightCluster<N> members;
    std::memcpy(static_cast<void*>(&members), lanes.data(), sizeof members);
    members.importance(at).copy_to(&weights[i], stdx::vector_aligned);
  }
  return sum_of(node, weights);
}

// Weighs the members of the root with points as lanes, because all points use the same members.
template <class T>
typename LightTree<T>::Choices LightTree<T>::choose(const Vec3<Lanes<T>>& positions,
                                                    const std::array<double, kPoints>& u) const {
  using N = Lanes<T>;
  const Node& root = nodes_.front();
  std::array<N, kMembers> importance;
  for (std::size_t i = 0; i < root.count; ++i) {
    std::array<N, kNumbers> lanes;
    for (std::size_t k = 0; k < kNumbers; ++k) lanes[k] = N(root.numbers[k][i]);
    LightCluster<N> member;
    std::memcpy(static_cast<void*>(&member), lanes.data(), sizeof member);
    importance[i] = member.importance(positions);
  }
  Choices choices;
  std::array<Descent, kPoints> descents;
  std::array<std::int32_t, kPoints> targets;
  Weights weights;
  // Moves a point one level down. Prefetches its next node, which loads while the other points move.
  const auto step = [&](std::size_t point, const Node& node, double sum) {
    const std::int32_t target = targets[point] = descents[point].step(node, weights, sum);
    if (target >= 0) return prefetch_lines(nodes_[static_cast<std::size_t>(target)]);
    choices.light[point] = static_cast<std::size_t>(~target);
    choices.probability[point] = static_cast<T>(descents[point].probability);
  };
  for (std::size_t point = 0; point < kPoints; ++point) {
    for (std::size_t i = 0; i < root.count; ++i) weights[i] = importance[i][point];
    descents[point] = {u[point]};
    step(point, root, sum_of(root, weights));
  }
  for (bool going = true; going;) {
    going = false;
    for (std::size_t point = 0; point < kPoints; ++point) {
      if (targets[point] < 0) continue;
      const Node& node = nodes_[static_cast<std::size_t>(targets[point])];
      step(point, node, weigh(node, {positions.x[point], positions.y[point], positions.z[point]}, weights));
      going = true;
    }
  }
  return choices;
}

template <class T>
T LightTree<T>::probability(const Vec3<T>& position, std::size_t light) const {
  Weights weights;
  double probability = 1;
  std::uint64_t path = path_of_[light];
  std::int32_t target = 0;
  do {
    const Node& node = nodes_[static_cast<std::size_t>(target)];
    const double sum = weigh(node, position, weights);
    probability *= double{weights[path & (kMembers - 1)]} / sum;
    target = node.target[path & (kMembers - 1)];
    path >>= 4;
  } while (target >= 0);
  return static_cast<T>(probability);
}

template class LightTree<float>;
template class LightTree<double>;

}  // namespace orrery
