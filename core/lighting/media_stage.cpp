#include "core/lighting/media_stage.h"

#include <algorithm>

#include "core/base/task_scope.h"
#include "core/lighting/lane_masks.h"
#include "core/lighting/surfaces.h"

namespace orrery {
namespace {

// Returns the unit direction of probes: parallel to no face or axis of usual scenes.
template <class T>
Vec3<T> probe_direction() {
  return safe_normalize(Vec3<T>(Vec3d(0.41713, 0.61291, 0.67104)));
}

std::size_t number(int i) { return static_cast<std::size_t>(i); }

// Returns the point behind the surface of a ray, farther than the rounding error of its position.
template <class T>
Vec3<T> beyond(const SurfaceBatch<T>& surface, int lane) {
  return surface.position[lane] - surface.geometric[lane] * surface.step[lane];
}

}  // namespace

template <class T>
MediaProbe<T>::MediaProbe(const Geometry<T>& geometry, const Accelerator<T>& accelerator)
    : geometry_(geometry),
      accelerator_(accelerator),
      media_(geometry.scene->media),
      has_half_spaces_(std::any_of(media_.bounds.begin(), media_.bounds.end(),
                                   [](const Boundsd& box) { return !box.bounded(); })),
      seen_(number(kBatchRoom)),
      inside_(number(kBatchRoom)) {}

template <class T>
void MediaProbe<T>::find(const LaneGroups& groups, MediaLists& lists, TraceCounts& counts) {
  for (const int i : groups)
    for (int lane = i; lane < i + kWidth<T>; ++lane) {
      seen_[number(lane)].clear();
      inside_[number(lane)].clear();
    }
  const Vec3<T> direction = probe_direction<T>();
  follow(direction, groups, counts);
  if (has_half_spaces_) follow(-direction, groups, counts);
  for (const int i : groups)
    for (int lane = i; lane < i + kWidth<T>; ++lane) {
      const std::vector<std::int32_t>& inside = inside_[number(lane)];
      lists[number(lane)] = {};
      for (auto body = inside.rbegin(); body != inside.rend(); ++body) lists[number(lane)].enter(*body);
    }
}

template <class T>
bool MediaProbe<T>::inside(std::int32_t body, const Vec3<T>& point, T time, TraceCounts& counts) {
  const Primitive<T>& primitive =
      geometry_.primitives[static_cast<std::size_t>(media_.primitive_of[number(body)])];
  const LaneGroups one = LaneGroups::single(0);
  for (const T sign : {T(1), T(-1)}) {
    const Vec3<T> direction = probe_direction<T>() * sign;
    for (int lane = 0; lane < kWidth<T>; ++lane)
      sent_.set(lane, {point, direction}, lane == 0 ? std::numeric_limits<T>::infinity() : T(-1));
    sent_.time[0] = time;
    reset(sent_, one, hits_);
    primitive.kernel->closest(primitive.index, sent_, one, hits_, counts.accelerator);
    if (hits_.primitive[0] == kNoPrimitive) continue;  // only half-spaces depend on the sign
    primitive.kernel->surface(sent_, hits_, one, surface_);
    return surface_.side[0] < 0;
  }
  return false;
}

template <class T>
void MediaProbe<T>::follow(const Vec3<T>& direction, const LaneGroups& groups, TraceCounts& counts) {
  LaneGroups active = with_active_rays(rays, groups);
  for (const int i : active) {
    sent_.origin.put(i, rays.origin.at(i));
    sent_.direction.put(i, Vec3<Lanes<T>>(direction));
    sent_.t_max.put(i, rays.t_max.at(i));
    sent_.time.put(i, rays.time.at(i));
  }
  while (!active.empty()) {
    checkpoint();
    reset(sent_, active, hits_);
    accelerator_.closest(sent_, active, hits_, counts.accelerator);
    const LaneGroups met = groups_with_hits(hits_, active);
    for (const auto& shapes : geometry_.shapes) shapes->surface(sent_, hits_, met, surface_);
    record(met);
    active = met;
  }
}

template <class T>
void MediaProbe<T>::record(const LaneGroups& groups) {
  for (const int i : groups) {
    const Vec3<Lanes<T>> next = surface_.origin_toward(i, sent_.direction.at(i));
    for (int lane = i; lane < i + kWidth<T>; ++lane) {
      const IndexOf<T> primitive = hits_.primitive[lane];
      if (primitive == kNoPrimitive) {
        sent_.t_max[lane] = -1;
        continue;
      }
      const auto k = number(lane - i);
      sent_.origin.set(lane, {next.x[k], next.y[k], next.z[k]});
      const std::int32_t body = media_.body_of[static_cast<std::size_t>(primitive)];
      if (body < 0 || media_.closed[number(body)] == 0) continue;
      std::vector<std::int32_t>& seen = seen_[number(lane)];
      if (std::find(seen.begin(), seen.end(), body) != seen.end()) continue;
      seen.push_back(body);
      if (surface_.side[lane] < 0) inside_[number(lane)].push_back(body);
    }
  }
}

template <class T>
MediaStage<T>::MediaStage(const Geometry<T>& geometry, const Accelerator<T>& accelerator, const Plan& plan)
    : geometry_(geometry),
      accelerator_(accelerator),
      plan_(plan),
      media_(geometry.scene->media),
      probe_(geometry, accelerator) {
  walked_.fill(-1);
  if (plan.scatters) walk_ = std::make_unique<RandomWalk<T>>(geometry, accelerator, plan);
}

template <class T>
void MediaStage<T>::start(PathBatch<T>& camera, TraceCounts& counts) {
  if (!plan_.eye_in_media) return camera.media->fill({});
  const RayBatch<T>& rays = camera.rays;
  const Vec3<T> eye = rays.origin[0];
  bool one_origin = plan_.shutter == 0;
  for (int i = 0; i < kBatch && one_origin; ++i) one_origin = rays.t_max[i] <= 0 || rays.origin[i] == eye;
  const LaneGroups sent = one_origin ? LaneGroups::single(0) : LaneGroups::covering(0, kBatch, kWidth<T>);
  for (const int i : sent) {
    probe_.rays.origin.put(i, rays.origin.at(i));
    probe_.rays.t_max.put(i, N(std::numeric_limits<T>::infinity()));
    if (plan_.shutter > 0) probe_.rays.time.put(i, rays.time.at(i));
  }
  probe_.find(sent, *camera.media, counts);
  if (one_origin) camera.media->fill(MediaList(camera.media->front()));
}

template <class T>
LaneGroups MediaStage<T>::pass(PathBatch<T>& paths, const LaneGroups& groups, const PathDraws<T>& draws,
                               HitBatch<T>& hits, SurfaceBatch<T>& surface, Vec3Array<T>& radiance,
                               TraceCounts& counts) {
  surface.relative_index = &relative_index_;
  surface.behind = &behind_;
  if (walk_) walk_->start(groups);
  for (const int i : groups) {
    passed_.put(i, N(T(0)));
    for (int lane = i; lane < i + kWidth<T>; ++lane) settled_[number(lane)] = false;
  }
  for (LaneGroups pending = groups; !pending.empty();) {
    checkpoint();
    if (walk_) walk(paths, pending, draws, hits, surface, radiance, counts);
    LaneGroups passing;
    for (const int i : pending)
      for (int lane = i; lane < i + kWidth<T>; ++lane)
        if (!settled_[number(lane)] && cross(paths, lane, hits, surface))
          find_touching(paths, lane, hits, surface, counts);
    for (const int i : pending) {
      bool passes = false;
      for (int lane = i; lane < i + kWidth<T>; ++lane)
        if (!settled_[number(lane)]) passes |= settle_or_pass(paths, lane, hits, surface);
      if (passes) passing.add(i);
    }
    if (!passing.empty()) {
      accelerator_.closest(paths.rays, passing, hits, counts.accelerator);
      find_surfaces(geometry_, plan_.fields, paths, passing, hits, surface, radiance);
    }
    pending = passing;
  }
  for (const int i : groups) {
    const auto moved = passed_.at(i) > N(T(0));
    if (!any(moved)) continue;
    paths.rays.origin.put(i, moved, origin_.at(i));
    hits.t.put(i, hits.t.at(i) + passed_.at(i));
  }
  return groups_with_hits(hits, groups);
}

template <class T>
void MediaStage<T>::walk(PathBatch<T>& paths, const LaneGroups& groups, const PathDraws<T>& draws,
                         HitBatch<T>& hits, SurfaceBatch<T>& surface, Vec3Array<T>& radiance,
                         TraceCounts& counts) {
  for (const int i : groups)
    for (int lane = i; lane < i + kWidth<T>; ++lane) {
      walked_[number(lane)] = -1;
      if (settled_[number(lane)] || !(paths.rays.t_max[lane] > 0)) continue;
      const std::int32_t top = (*paths.media)[number(lane)].top(media_.bodies);
      if (top < 0 || !media_.bodies[number(top)].scatters()) continue;
      walked_[number(lane)] = top;
      walk_->add(paths, lane, hits, top);
    }
  if (walk_->empty()) return;
  walk_->run(paths, draws, hits, counts);
  std::array<bool, kBatchRoom> moved{};  // by the first ray of each register
  for (const int lane : walk_->moved()) {
    passed_[lane] = 0;
    moved[number(lane - lane % kWidth<T>)] = true;
  }
  LaneGroups changed;
  for (const int i : groups)
    if (moved[number(i)]) changed.add(i);
  if (!changed.empty()) find_surfaces(geometry_, plan_.fields, paths, changed, hits, surface, radiance);
}

template <class T>
void MediaStage<T>::attenuate(PathBatch<T>& paths, int lane, const Medium& medium, T distance) const {
  const Vec3<T> rate(medium.log2_filter);
  if (rate == Vec3<T>(T(0))) return;
  paths.throughput.set(lane, paths.throughput[lane] * transmittance_of(rate, distance));
}

template <class T>
bool MediaStage<T>::cross(PathBatch<T>& paths, int lane, const HitBatch<T>& hits,
                          const SurfaceBatch<T>& surface) {
  MediaList& around = (*paths.media)[number(lane)];
  MediaList& behind = behind_[number(lane)] = around;
  const IndexOf<T> primitive = hits.primitive[lane];
  if (primitive == kNoPrimitive) return false;
  const std::int32_t body = media_.body_of[static_cast<std::size_t>(primitive)];
  const bool leaves = surface.side[lane] < 0, closed = body >= 0 && media_.closed[number(body)] != 0;
  if (leaves && closed) around.enter(body);  // no effect if the ray is known to be inside
  const std::int32_t top = leaves && body >= 0 && !closed ? body : around.top(media_.bodies);
  if (top >= 0 && top != walked_[number(lane)])
    attenuate(paths, lane, media_.bodies[number(top)], hits.t[lane]);
  if (!closed) return false;
  behind = around;
  if (leaves)
    behind.leave(body);
  else
    behind.enter(body);
  return true;
}

template <class T>
void MediaStage<T>::find_touching(const PathBatch<T>& paths, int lane, const HitBatch<T>& hits,
                                  const SurfaceBatch<T>& surface, TraceCounts& counts) {
  const auto body = number(media_.body_of[static_cast<std::size_t>(hits.primitive[lane])]);
  MediaList& behind = behind_[number(lane)];
  for (const std::int32_t other : media_.touching[body])
    if (probe_.inside(other, beyond(surface, lane), plan_.shutter > 0 ? paths.rays.time[lane] : T(0), counts))
      behind.enter(other);
    else
      behind.leave(other);
}

template <class T>
bool MediaStage<T>::settle_or_pass(PathBatch<T>& paths, int lane, HitBatch<T>& hits,
                                   const SurfaceBatch<T>& surface) {
  settled_[number(lane)] = true;
  relative_index_[lane] = 1;
  const IndexOf<T> primitive = hits.primitive[lane];
  const std::int32_t body =
      primitive == kNoPrimitive ? -1 : media_.body_of[static_cast<std::size_t>(primitive)];
  if (body < 0) return false;
  const Medium& medium = media_.bodies[number(body)];
  MediaList& around = (*paths.media)[number(lane)];
  const MediaList& behind = behind_[number(lane)];
  const double here = index_of(around), there = index_of(behind);
  if (media_.closed[number(body)] == 0) {
    relative_index_[lane] = static_cast<T>(medium.ior / here);
    return false;
  }
  const bool hidden = around.top(media_.bodies) == behind.top(media_.bodies);
  if (!hidden && !(medium.refracts_only && here == there)) {
    relative_index_[lane] = static_cast<T>(surface.side[lane] < 0 ? here / there : there / here);
    return false;
  }
  settled_[number(lane)] = false;
  around = behind;
  if (passed_[lane] == 0) origin_.set(lane, paths.rays.origin[lane]);
  passed_[lane] += hits.t[lane];
  paths.rays.origin.set(lane, beyond(surface, lane));
  if (plan_.fields.footprint) paths.width[lane] += paths.spread[lane] * hits.t[lane];
  paths.pdf[lane] = 0;
  hits.t[lane] = paths.rays.t_max[lane];
  hits.primitive[lane] = kNoPrimitive;
  return true;
}

template <class T>
void MediaStage<T>::inherit(const PathBatch<T>& paths, int i, const MaskOf<Lanes<T>>& crosses, unsigned bits,
                            PathBatch<T>& into) const {
  int to = into.rays.count - std::popcount(bits);
  for (; bits != 0; bits &= bits - 1) {
    const int lane = std::countr_zero(bits);
    const MediaLists& from = crosses[number(lane)] ? behind_ : *paths.media;
    (*into.media)[number(to++)] = from[number(i + lane)];
  }
}

template class MediaProbe<float>;
template class MediaProbe<double>;
template class MediaStage<float>;
template class MediaStage<double>;

}  // namespace orrery
