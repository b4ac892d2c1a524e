#include "core/stages/path_reuse.h"

#include <algorithm>
#include <numbers>
#include <numeric>

#include "core/stages/shadowed_light.h"

namespace orrery {

template <class T>
PathReuse<T>::PathReuse(const Geometry<T>& geometry, const Accelerator<T>& accelerator, const Plan& plan)
    : geometry_(geometry),
      accelerator_(accelerator),
      group_(plan.reuse),
      slot_at_(kBatch),
      place_of_(kBatch),
      connections_(static_cast<std::size_t>(plan.reuse)) {}

template <class T>
void PathReuse<T>::begin(const Draws& draws) {
  std::array<std::uint32_t, kBatch> keys;
  draws.shuffle_keys(keys);
  std::iota(slot_at_.begin(), slot_at_.end(), 0);
  std::sort(slot_at_.begin(), slot_at_.end(), [&](int a, int b) {
    const auto key = [&](int slot) { return std::pair(keys[static_cast<std::size_t>(slot)], slot); };
    return key(a) < key(b);
  });
  for (int place = 0; place < kBatch; ++place)
    place_of_[static_cast<std::size_t>(slot_at_[static_cast<std::size_t>(place)])] = place;
  const N zero(T(0));
  for (const int i : all_) {
    pdf_.put(i, zero);
    lit_.put(i, zero);
    shared_.put(i, zero);
    weight_.put(i, Vec3<N>(zero));
    suffix_.put(i, Vec3<N>(zero));
  }
}

template <class T>
void PathReuse<T>::keep_first(int i, const PathBatch<T>& paths, const SurfaceBatch<T>& surface,
                              const ScatterBatch<T>& scatter, const MaskOf<N>& alive, const MaskOf<N>& drawn,
                              const MaskOf<N>& lit) {
  first_.position.put(i, surface.position.at(i));
  first_.normal.put(i, surface.normal.at(i));
  first_.geometric.put(i, surface.geometric.at(i));
  first_.side.put(i, surface.side.at(i));
  first_.step.put(i, surface.step.at(i));
  first_.material.put(i, load_index<T>(surface.material, i));
  ray_.put(i, paths.rays.direction.at(i));
  weight_.put(i, alive, scatter.weight.at(i));
  first_.travelled.put(i, surface.travelled.at(i));
  pdf_.put(i, drawn, scatter.pdf.at(i));
  lit_.put(i, lit, N(T(1)));
}

template <class T>
void PathReuse<T>::keep_second(int i, const PathBatch<T>& paths, const SurfaceBatch<T>& surface,
                               const MaskOf<N>& shared) {
  for (unsigned bits = bits_of(shared); bits != 0; bits &= bits - 1) {
    const int lane = i + std::countr_zero(bits);
    const int slot = static_cast<int>(paths.slot[lane]);
    if (!(pdf_[slot] > 0)) continue;  // found through a mirror: no density of the others tells how likely
    position_.set(slot, surface.position[lane]);
    geometric_.set(slot, surface.geometric[lane]);
    step_[slot] = surface.step[lane];
    shared_[slot] = 1;
  }
}

// A slot's own second vertex is seen: that is how it was found.
template <class T>
void PathReuse<T>::connect_own(Connections& own) {
  const N zero(T(0));
  for (const int i : all_) {
    const auto shared = shared_.at(i) > zero;
    const Vec3<N> line = position_.at(i) - first_.position.at(i);
    const N distance2 = dot(line, line);
    using std::sqrt;
    const N cosine = max_first(zero, N(-dot(line, geometric_.at(i)) / sqrt(distance2)));
    const N density = select(shared && distance2 > zero, N(pdf_.at(i) * cosine / distance2), zero);
    own.density.put(i, density);
    own.share.put(i, weight_.at(i) * density);
  }
}

// Also of those whose own draw failed or went through a mirror: how likely they would have drawn a second
// vertex is what weighs it. Rays from first vertices to the second vertices of their partners, which end
// before these by as much as rounding may move either.
template <class T>
void PathReuse<T>::aim(int turn) {
  Vec3Array<T>& target = shadow_.origin;  // until origins are known
  for (int slot = 0; slot < kBatch; ++slot) {
    const int other = partner(slot, turn);
    const bool connected = lit_[slot] > 0 && shared_[other] > 0;
    shadow_.t_max[slot] = connected ? T(1) : T(-1);
    const int from = connected ? other : slot;
    const T step = connected ? 2 * (step_[other] + first_.step[slot]) : T(0);
    const Vec3<T> normal = connected ? geometric_[from] : Vec3<T>();
    toward_normal_.set(slot, normal);
    target.set(slot, connected ? position_[from] + normal * step : Vec3<T>());
  }
  const N zero(T(0));
  for (const int i : all_) {
    const auto connected = shadow_.t_max.at(i) > zero;
    const Vec3<N> line = target.at(i) - first_.position.at(i);
    const N distance = length(line);
    const auto usable = connected && distance > zero;
    shadow_.direction.put(i, line * select(usable, N(T(1) / distance), zero));
    shadow_.t_max.put(i, select(usable, distance, N(T(-1))));
  }
}

template <class T>
void PathReuse<T>::connect(int turn, Connections& to, TraceCounts& counts) {
  const N zero(T(0));
  aim(turn);
  const Groups connected = with_active_rays(shadow_, all_);
  for (const int i : all_) {
    to.density.put(i, zero);
    to.share.put(i, Vec3<N>(zero));
  }
  if (connected.empty()) return;
  evaluate_materials(geometry_, {ray_, shadow_.direction, shadow_.t_max}, first_, connected, Lobes::all,
                     f_cos_, lobe_pdf_);
  for (const int i : connected) {
    const N t = shadow_.t_max.at(i);
    const N cosine = -dot(shadow_.direction.at(i), toward_normal_.at(i));
    // As a draw goes on only where some light would.
    const auto possible =
        t > zero && lobe_pdf_.at(i) > zero && cosine > zero && max_component(f_cos_.at(i)) > zero;
    const N change = select(possible, N(cosine / (t * t)), zero);  // from solid angle to area
    constexpr T kPi = std::numbers::pi_v<T>;
    to.density.put(i, lobe_pdf_.at(i) * change);
    to.share.put(i, possible, f_cos_.at(i) * (change * N(T(1) / kPi)));
    shadow_.t_max.put(i, !possible, N(T(-1)));
    shadow_.origin.put(i, first_.origin_toward(i, shadow_.direction.at(i)));
  }
  counts.rays.shadow[0] += active_rays(shadow_, connected);
  accelerator_.occlude(shadow_, connected, counts.accelerator);
  for (const int i : connected) {
    const auto hidden = !(shadow_.t_max.at(i) > zero);
    to.density.put(i, hidden, zero);
    to.share.put(i, hidden, Vec3<N>(zero));
  }
}

// total_: of each second vertex, over all that could have drawn it.
template <class T>
void PathReuse<T>::sum_densities() {
  for (int slot = 0; slot < kBatch; ++slot) {
    T sum = 0;
    for (int turn = 0; turn < group_; ++turn)
      sum += connections_[static_cast<std::size_t>(turn)].density[partner(slot, group_ - turn)];
    total_[slot] = sum;
  }
}

template <class T>
bool PathReuse<T>::finish(Vec3Array<T>& radiance, TraceCounts& counts, const Checkpoint& checkpoint) {
  connect_own(connections_.front());
  for (int turn = 1; turn < group_; ++turn) {
    if (!checkpoint.go_on()) return false;
    connect(turn, connections_[static_cast<std::size_t>(turn)], counts);
  }
  sum_densities();
  for (int slot = 0; slot < kBatch; ++slot) {
    Vec3<T> found;
    const bool takes_part = shared_[slot] > 0 && pdf_[slot] > 0 && total_[slot] > 0;
    if (!takes_part) found = weight_[slot] * suffix_[slot];
    for (int turn = 0; turn < group_; ++turn) {
      const int other = partner(slot, turn);
      if (turn == 0 && !takes_part) continue;
      const T total = total_[other];
      const Connections& connections = connections_[static_cast<std::size_t>(turn)];
      if (!(total > 0) || !(connections.density[slot] > 0)) continue;
      const Vec3<T> share = connections.share[slot];
      found = found + share * suffix_[other] * (T(1) / total);
    }
    radiance.set(slot, radiance[slot] + found);
  }
  return true;
}

template class PathReuse<float>;
template class PathReuse<double>;

}  // namespace orrery
