#include "core/reuse/path_reuse.h"

#include <algorithm>
#include <bit>
#include <numbers>
#include <numeric>

#include "core/base/task_scope.h"
#include "core/lighting/shadowed_light.h"

namespace orrery {
namespace {

// Returns the indices of `keys`, sorted by key and then by index, in the low 32 bits of the elements. The
// highest bits of a key select its bucket. Keys are random, so the final insertion sort moves few elements.
std::array<std::uint64_t, kBatch> in_order(const std::array<std::uint32_t, kBatch>& keys) {
  constexpr int kLowBits = 32 - std::countr_zero(static_cast<unsigned>(kBatch));
  std::array<std::uint16_t, kBatch + 1> begins{};
  for (const std::uint32_t key : keys) ++begins[(key >> kLowBits) + 1];
  std::partial_sum(begins.begin(), begins.end(), begins.begin());
  std::array<std::uint64_t, kBatch> order;
  for (std::size_t slot = 0; slot < kBatch; ++slot)
    order[begins[keys[slot] >> kLowBits]++] = std::uint64_t{keys[slot]} << 32 | slot;
  for (std::size_t i = 1; i < kBatch; ++i)
    for (std::size_t j = i; j > 0 && order[j] < order[j - 1]; --j) std::swap(order[j], order[j - 1]);
  return order;
}

// Returns records[index[i + lane]] in each lane.
template <template <class> class Record, class T>
Record<Lanes<T>> records_at(const std::vector<Record<T>>& records, const Array<IndexOf<T>>& index, int i) {
  return gather_records<Record, T>(records, load_index<T>(index, i), MaskOf<Lanes<T>>(true), 0);
}

}  // namespace

template <class T>
PathReuse<T>::PathReuse(const Geometry<T>& geometry, const Accelerator<T>& accelerator, const Plan& plan)
    : geometry_(geometry),
      accelerator_(accelerator),
      group_(plan.reuse),
      partners_(static_cast<std::size_t>(plan.reuse)),
      second_(kBatch),
      arrivals_(kBatch),
      connections_(static_cast<std::size_t>(plan.reuse)) {}

template <class T>
void PathReuse<T>::begin(const Draws& draws) {
  std::array<std::uint32_t, kBatch> keys;
  draws.shuffle_keys(keys);
  const std::array<std::uint64_t, kBatch> order = in_order(keys);
  const auto slot_at = [&](int place) {  // consecutive places form a group
    return static_cast<std::uint32_t>(order[static_cast<std::size_t>(place)]);
  };
  for (int first = 0; first < kBatch; first += group_)
    for (int turn = 0; turn < group_; ++turn)
      for (int within = 0; within < group_; ++within)
        partners_[static_cast<std::size_t>(turn)].values[slot_at(first + within)] =
            static_cast<IndexOf<T>>(slot_at(first + ((within + turn) & (group_ - 1))));
  kept_ = {};
  for (SecondVertex<T>& second : second_) second.shared = 0;
  for (Arrival<T>& arrival : arrivals_) arrival.inverse_density = 0;
  for (const int i : all_) suffix_.put(i, Vec3<N>(N(T(0))));
}

template <class T>
void PathReuse<T>::keep_first(int i, const PathBatch<T>& paths, const SurfaceBatch<T>& surface,
                              const ScatterBatch<T>& scatter, const MaskOf<N>& alive, const MaskOf<N>& drawn,
                              const MaskOf<N>& lit) {
  const N zero(T(0));
  kept_.add(i);
  first_.position.put(i, surface.position.at(i));
  first_.normal.put(i, surface.normal.at(i));
  first_.geometric.put(i, surface.geometric.at(i));
  first_.side.put(i, surface.side.at(i));
  first_.step.put(i, surface.step.at(i));
  first_.material.put(i, load_index<T>(surface.material, i));
  ray_.put(i, paths.rays.direction.at(i));
  weight_.put(i, select(alive, scatter.weight.at(i), Vec3<N>(zero)));
  first_.travelled.put(i, surface.travelled.at(i));
  if (first_.textured.size() < surface.textured.size()) first_.textured.resize(surface.textured.size());
  for (std::size_t slot = 0; slot < surface.textured.size(); ++slot)
    first_.textured[slot].put(i, surface.textured[slot].at(i));
  pdf_.put(i, select(drawn, scatter.pdf.at(i), zero));
  lit_.put(i, select(lit, N(T(1)), zero));
}

template <class T>
void PathReuse<T>::keep_second(int i, const PathBatch<T>& paths, const SurfaceBatch<T>& surface,
                               const MaskOf<N>& shared) {
  for (unsigned bits = bits_of(shared); bits != 0; bits &= bits - 1) {
    const int lane = i + std::countr_zero(bits);
    const int slot = static_cast<int>(paths.slot[lane]);
    if (!(pdf_[slot] > 0)) continue;  // specular direction: other paths cannot sample it
    second_[static_cast<std::size_t>(slot)] = {surface.position[lane], surface.geometric[lane],
                                               surface.step[lane], 1};
  }
}

// Connects each first vertex to the second vertex of its own path, which is visible by construction.
template <class T>
void PathReuse<T>::connect_own(Connections& own) {
  const N zero(T(0));
  for (const int i : kept_) {
    const SecondVertex<N> second = records_at<SecondVertex, T>(second_, partners_.front(), i);
    const Vec3<N> line = second.position - first_.position.at(i);
    const N distance2 = dot(line, line);
    using std::sqrt;
    const N cosine = max_first(zero, N(-dot(line, second.geometric) / sqrt(distance2)));
    const N density =
        select(second.shared > zero && distance2 > zero, N(pdf_.at(i) * cosine / distance2), zero);
    own.density.put(i, density);
    own.share.put(i, weight_.at(i) * density);
  }
}

// Makes shadow rays from first vertices to the second vertices of their partners. The rays end before the
// second vertex, by twice the rounding errors of both vertices. First vertices whose own sample failed or was
// specular are included, because their densities enter the weights.
template <class T>
void PathReuse<T>::aim(int turn) {
  const N zero(T(0)), two(T(2));
  for (const int i : kept_) {
    const SecondVertex<N> second =
        records_at<SecondVertex, T>(second_, partners_[static_cast<std::size_t>(turn)], i);
    toward_normal_.put(i, second.geometric);
    const N step = two * (second.step + first_.step.at(i));
    const Vec3<N> line = second.position + second.geometric * step - first_.position.at(i);
    const N distance = length(line);
    const auto usable = lit_.at(i) > zero && second.shared > zero && distance > zero;
    shadow_.direction.put(i, line * select(usable, N(T(1) / distance), zero));
    shadow_.t_max.put(i, select(usable, distance, N(T(-1))));
  }
}

template <class T>
void PathReuse<T>::connect(int turn, Connections& to, TraceCounts& counts) {
  const N zero(T(0));
  aim(turn);
  const LaneGroups connected = with_active_rays(shadow_, kept_);
  for (const int i : all_) to.density.put(i, zero);
  if (connected.empty()) return;
  evaluate_materials(geometry_, {ray_, shadow_.direction, shadow_.t_max}, first_, connected, Lobes::all,
                     f_cos_, lobe_pdf_);
  for (const int i : connected) {
    const N t = shadow_.t_max.at(i);
    const N cosine = -dot(shadow_.direction.at(i), toward_normal_.at(i));
    // Same condition as for sampled directions in PathTracer::continue_path().
    const auto possible =
        t > zero && lobe_pdf_.at(i) > zero && cosine > zero && max_component(f_cos_.at(i)) > zero;
    const N change = select(possible, N(cosine / (t * t)), zero);  // converts solid angle to area
    constexpr T kPi = std::numbers::pi_v<T>;
    to.density.put(i, lobe_pdf_.at(i) * change);
    to.share.put(i, f_cos_.at(i) * (change * N(T(1) / kPi)));
    shadow_.t_max.put(i, !possible, N(T(-1)));
    shadow_.origin.put(i, first_.origin_toward(i, shadow_.direction.at(i)));
  }
  counts.rays.shadow[0] += active_rays(shadow_, connected);
  accelerator_.occlude(shadow_, connected, counts.accelerator);
  for (const int i : connected) to.density.put(i, !(shadow_.t_max.at(i) > zero), zero);
}

// Sums the densities of each second vertex over all paths of its group that could have sampled it.
template <class T>
void PathReuse<T>::find_arrivals() {
  for (const int i : kept_) {
    N density = connections_.front().density.at(i);
    for (int turn = 1; turn < group_; ++turn) {
      const Array<T>& of_turn = connections_[static_cast<std::size_t>(turn)].density;
      const Array<IndexOf<T>>& by = partners_[static_cast<std::size_t>(group_ - turn)];
      density += N([&](auto lane) { return of_turn[static_cast<int>(by[i + static_cast<int>(lane)])]; });
    }
    for (int slot = i; slot < i + kWidth<T>; ++slot) {
      const T total = density[static_cast<std::size_t>(slot - i)];
      arrivals_[static_cast<std::size_t>(slot)] = {suffix_[slot], total > 0 ? 1 / total : 0};
    }
  }
}

template <class T>
Vec3<Lanes<T>> PathReuse<T>::received(int i) const {
  const N zero(T(0));
  Vec3<N> sum(zero);
  for (std::size_t turn = 0; turn < connections_.size(); ++turn) {
    const Connections& to = connections_[turn];
    const Arrival<N> arrival = records_at<Arrival, T>(arrivals_, partners_[turn], i);
    const auto drawn = arrival.inverse_density > zero;
    // If the density is 0, only the path of the vertex itself contributes.
    if (turn == 0) sum = select(drawn, sum, weight_.at(i) * arrival.suffix);
    const auto connected = drawn && to.density.at(i) > zero;
    sum = sum + select(connected, to.share.at(i) * arrival.suffix * arrival.inverse_density, Vec3<N>(zero));
  }
  return sum;
}

template <class T>
void PathReuse<T>::finish(Vec3Array<T>& radiance, TraceCounts& counts) {
  connect_own(connections_.front());
  for (int turn = 1; turn < group_; ++turn) {
    checkpoint();
    connect(turn, connections_[static_cast<std::size_t>(turn)], counts);
  }
  find_arrivals();
  for (const int i : kept_) radiance.put(i, radiance.at(i) + received(i));
}

template class PathReuse<float>;
template class PathReuse<double>;

}  // namespace orrery
