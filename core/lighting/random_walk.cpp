#include "core/lighting/random_walk.h"

#include <bit>

#include "core/base/task_scope.h"
#include "core/lighting/lane_masks.h"
#include "core/math/compress.h"
#include "core/math/henyey_greenstein.h"

namespace orrery {
namespace {

// Number of events between two tests whether a ray has strayed out of the bounds of its body, through a gap
// or by rounding.
constexpr int kStrayPeriod = 32;

}  // namespace

template <class T>
RandomWalk<T>::RandomWalk(const Geometry<T>& geometry, const Accelerator<T>& accelerator, const Plan& plan)
    : geometry_(geometry), accelerator_(accelerator), plan_(plan), media_(geometry.scene->media) {
  rays_.count = 0;
}

template <class T>
void RandomWalk<T>::start(const LaneGroups& groups) {
  rays_.count = 0;  // not 0 after an exception
  omitted_.clear();
  for (const int i : groups)
    for (int lane = i; lane < i + kWidth<T>; ++lane) events_[lane] = 0;
}

template <class T>
void RandomWalk<T>::add(const PathBatch<T>& paths, int lane, const HitBatch<T>& hits, std::int32_t body) {
  const int to = rays_.count++;
  const Medium& medium = media_.bodies[static_cast<std::size_t>(body)];
  rays_.set(to, paths.rays[lane], paths.rays.t_max[lane]);
  if (plan_.shutter > 0) rays_.time[to] = paths.rays.time[lane];
  hits_.t[to] = hits.t[lane];
  hits_.primitive[to] = hits.primitive[lane];
  throughput_.set(to, paths.throughput[lane]);
  rate_.set(to, Vec3<T>(-medium.log2_filter));
  albedo_.set(to, Vec3<T>(medium.albedo));
  anisotropy_[to] = static_cast<T>(medium.anisotropy);
  walked_[to] = 0;
  slot_[to] = paths.slot[lane];
  lane_[to] = static_cast<IndexOf<T>>(lane);
  body_[to] = static_cast<IndexOf<T>>(body);
  event_[to] = events_[lane];
}

template <class T>
void RandomWalk<T>::run(PathBatch<T>& paths, const PathDraws<T>& draws, HitBatch<T>& hits,
                        TraceCounts& counts) {
  moved_.clear();
  for (bool known_hits = true; rays_.count > 0; known_hits = false) {
    checkpoint();
    const LaneGroups groups = LaneGroups::covering(0, rays_.count, kWidth<T>);
    for (const int i : groups) sample_distance(i, draws, known_hits);
    if (!known_hits) accelerator_.closest(rays_, groups, hits_, counts.accelerator);
    int kept = 0;
    for (const int i : groups) {
      const auto scattered = weigh(i) && used_lanes(i);
      const auto alive = any(scattered) ? scatter(i, scattered, draws) : scattered;
      const auto goes_on = finish(i, scattered, alive, paths, hits, counts);
      kept = keep(i, goes_on, kept);
    }
    rays_.count = kept;
  }
}

template <class T>
void RandomWalk<T>::sample_distance(int i, const PathDraws<T>& draws, bool known_hits) {
  const N one(T(1));
  const Vec3<N> throughput = throughput_.at(i), rate = rate_.at(i);
  const auto [u, v] = draws.draws.template two<T>(EventSet::distance, draws.depth, load_index<T>(slot_, i),
                                                  load_index<T>(event_, i));
  const N first_two = throughput.x + throughput.y, choice = u * (first_two + throughput.z);
  const N chosen = select(choice < throughput.x, rate.x, select(choice < first_two, rate.y, rate.z));
  const N distance = -log2_normal(N(one - v)) / chosen;
  const auto active = used_lanes(i);
  const auto nearer = active && (known_hits ? distance < hits_.t.at(i) : active);
  hits_.t.put(i, nearer, distance);
  if (!known_hits) {
    hits_.t.put(i, !active, N(-one));
    rays_.t_max.put(i, hits_.t.at(i));
  }
  const IndexLanes<T> none(IndexOf<T>{kNoPrimitive});
  stdx::where(mask_cast<IndexLanes<T>>(nearer), none)
      .copy_to(&hits_.primitive.values[static_cast<std::size_t>(i)], stdx::vector_aligned);
}

template <class T>
MaskOf<Lanes<T>> RandomWalk<T>::weigh(int i) {
  const N zero(T(0)), one(T(1));
  const auto scattered = missed_lanes(hits_, i);
  const Vec3<N> throughput = throughput_.at(i), rate = rate_.at(i);
  const Vec3<N> passed = transmittance_of(-rate, max_first(zero, hits_.t.at(i)));
  const Vec3<N> density = select(scattered, passed * rate, passed);
  const Vec3<N> weighted = throughput * density;
  const N all = throughput.x + throughput.y + throughput.z, mean = weighted.x + weighted.y + weighted.z;
  const auto possible = mean > zero;
  const N scale = select(possible, N(all / select(possible, mean, one)), zero);
  throughput_.put(i, weighted * scale * select(scattered, albedo_.at(i), Vec3<N>(one)));
  return scattered;
}

template <class T>
MaskOf<Lanes<T>> RandomWalk<T>::scatter(int i, const MaskOf<N>& scattered, const PathDraws<T>& draws) {
  using std::sqrt;
  const N one(T(1)), zero(T(0)), distance = hits_.t.at(i);
  const IndexLanes<T> slot = load_index<T>(slot_, i), event = load_index<T>(event_, i);
  const Vec3<N> direction = rays_.direction.at(i);
  const auto [u, v] = draws.draws.template two<T>(EventSet::direction, draws.depth, slot, event);
  rays_.origin.put(i, scattered, rays_.origin.at(i) + direction * distance);
  rays_.direction.put(i, scattered, henyey_greenstein_direction(direction, anisotropy_.at(i), u, v));
  walked_.put(i, scattered, walked_.at(i) + distance);
  stdx::where(mask_cast<IndexLanes<T>>(scattered), event + 1)
      .copy_to(&event_.values[static_cast<std::size_t>(i)], stdx::vector_aligned);
  const Vec3<N> throughput = throughput_.at(i);
  const N most = max_component(throughput);
  auto alive = scattered && most > zero;
  constexpr T kMinChance = T(0.05);
  const N chance = min_first(one, max_first(N(kMinChance), sqrt(select(alive, most, one))));
  if (!any(chance < one)) return alive;
  const N luck = draws.draws.template two<T>(EventSet::survival, draws.depth, slot, event).u;
  throughput_.put(i, scattered, throughput * (one / chance));
  return alive && luck < chance;
}

template <class T>
MaskOf<Lanes<T>> RandomWalk<T>::finish(int i, const MaskOf<N>& scattered, MaskOf<N> alive,
                                       PathBatch<T>& paths, HitBatch<T>& hits, TraceCounts& counts) {
  counts.scatterings += static_cast<std::uint64_t>(stdx::popcount(scattered));
  for (int k = i; k < std::min(i + kWidth<T>, rays_.count); ++k) {
    const auto lane = static_cast<std::size_t>(k - i);
    if (!scattered[lane]) {
      write_back(k, false, paths, hits);
      continue;
    }
    if (alive[lane] && (event_[k] >= kMaxScatterings || strayed(k))) {
      omitted_.push_back({static_cast<int>(lane_[k]), throughput_[k]});
      alive[lane] = false;
    }
    if (!alive[lane]) write_back(k, true, paths, hits);
  }
  return alive;
}

template <class T>
bool RandomWalk<T>::strayed(int i) const {
  if (event_[i] % kStrayPeriod != 0) return false;
  return !media_.bounds[static_cast<std::size_t>(body_[i])].contains(Vec3d(rays_.origin[i]));
}

template <class T>
void RandomWalk<T>::write_back(int from, bool ended, PathBatch<T>& paths, HitBatch<T>& hits) {
  const int lane = static_cast<int>(lane_[from]);
  paths.throughput.set(lane, ended ? Vec3<T>() : throughput_[from]);
  const bool moved = event_[from] != events_[lane];
  events_[lane] = event_[from] + 1;  // the distance of event_[from] has used its random numbers
  if (!moved) return;
  paths.rays.origin.set(lane, rays_.origin[from]);
  paths.rays.direction.set(lane, rays_.direction[from]);
  paths.pdf[lane] = 0;
  if (plan_.fields.footprint) paths.width[lane] += paths.spread[lane] * walked_[from];
  hits.t[lane] = ended ? paths.rays.t_max[lane] : hits_.t[from];
  hits.primitive[lane] = ended ? IndexOf<T>{kNoPrimitive} : hits_.primitive[from];
  moved_.push_back(lane);
}

template <class T>
int RandomWalk<T>::keep(int i, const MaskOf<N>& mask, int count) {
  const unsigned bits = bits_of(mask);
  if (bits == 0) return count;
  const int kept = count + std::popcount(bits);
  if (count == i && kept == i + kWidth<T>) return kept;
  const auto pack = [&](Array<T>& array) { compress_store(array.at(i), bits, &array[count]); };
  const auto pack3 = [&](Vec3Array<T>& array) {
    pack(array.x);
    pack(array.y);
    pack(array.z);
  };
  const auto pack_index = [&](Array<IndexOf<T>>& array) {
    compress_store(load_index<T>(array, i), bits, &array[count]);
  };
  pack3(rays_.origin);
  pack3(rays_.direction);
  if (plan_.shutter > 0) pack(rays_.time);
  pack3(throughput_);
  pack3(rate_);
  pack3(albedo_);
  pack(anisotropy_);
  pack(walked_);
  pack_index(slot_);
  pack_index(lane_);
  pack_index(body_);
  pack_index(event_);
  return kept;
}

template class RandomWalk<float>;
template class RandomWalk<double>;

}  // namespace orrery
