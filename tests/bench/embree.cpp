#include "tests/bench/embree.h"

#include <embree3/rtcore.h>

#include <atomic>
#include <cstring>
#include <limits>

#include "tests/bench/measuring.h"

namespace orrery::bench {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

RTCIntersectContext context_for(RTCIntersectContextFlags flags) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = flags;
  return context;
}

RTCRay ray_of(const Ray<float>& ray, float t_max) {
  RTCRay out{};
  out.org_x = ray.origin.x, out.org_y = ray.origin.y, out.org_z = ray.origin.z;
  out.dir_x = ray.direction.x, out.dir_y = ray.direction.y, out.dir_z = ray.direction.z;
  out.tfar = t_max, out.mask = ~0u;
  return out;
}

}  // namespace

struct Embree::Parts {
  RTCDevice device = rtcNewDevice("threads=1");
  RTCScene scene = rtcNewScene(device);
  std::atomic<ssize_t> bytes{0};
  double build_s = 0;
};

Embree::Embree(const Mesh& mesh, bool robust) : parts_(std::make_unique<Parts>()) {
  const auto count_bytes = [](void* parts, ssize_t bytes, bool) {
    static_cast<Parts*>(parts)->bytes += bytes;
    return true;
  };
  rtcSetSceneBuildQuality(parts_->scene, RTC_BUILD_QUALITY_HIGH);
  if (robust) rtcSetSceneFlags(parts_->scene, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(parts_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12,
                                           mesh.positions.size());
  std::memcpy(vertices, mesh.positions.data(), 12 * mesh.positions.size());
  void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12,
                                          mesh.triangles.size());
  std::memcpy(indices, mesh.triangles.data(), 12 * mesh.triangles.size());
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(parts_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcSetDeviceMemoryMonitorFunction(parts_->device, count_bytes, parts_.get());
  const double start = thread_seconds();
  rtcCommitScene(parts_->scene);
  parts_->build_s = thread_seconds() - start;
}

Embree::~Embree() {
  rtcReleaseScene(parts_->scene);
  rtcReleaseDevice(parts_->device);
}

double Embree::build_s() const { return parts_->build_s; }
std::size_t Embree::bytes() const { return static_cast<std::size_t>(parts_->bytes); }

double Embree::closest_in_packets(const RaySet& set) const {
  const auto& rays = set.rays;
  std::vector<RTCRayHit16> packets(rays.size() / 16);
  for (std::size_t n = 0; n < packets.size() * 16; ++n) {
    RTCRayHit16& p = packets[n / 16];
    const std::size_t i = n % 16;
    p.ray.org_x[i] = rays[n].origin.x, p.ray.org_y[i] = rays[n].origin.y, p.ray.org_z[i] = rays[n].origin.z;
    p.ray.dir_x[i] = rays[n].direction.x, p.ray.dir_y[i] = rays[n].direction.y,
    p.ray.dir_z[i] = rays[n].direction.z;
    p.ray.tnear[i] = 0, p.ray.tfar[i] = kInfinity;
    p.ray.mask[i] = ~0u, p.ray.flags[i] = 0, p.ray.time[i] = 0, p.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
  }
  alignas(64) int valid[16];
  std::fill(valid, valid + 16, -1);
  RTCIntersectContext context = context_for(RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
  const double start = thread_seconds();
  for (auto& packet : packets) rtcIntersect16(valid, parts_->scene, &context, &packet);
  return thread_seconds() - start;
}

double Embree::closest(const RaySet& set, std::size_t& found) const {
  const auto& rays = set.rays;
  std::vector<RTCRayHit> hits(rays.size());
  for (std::size_t n = 0; n < rays.size(); ++n) {
    hits[n].ray = ray_of(rays[n], set.t_max[n]);
    hits[n].hit.geomID = RTC_INVALID_GEOMETRY_ID;
  }
  RTCIntersectContext context = context_for(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
  const double start = thread_seconds();
  for (auto& hit : hits) rtcIntersect1(parts_->scene, &context, &hit);
  const double seconds = thread_seconds() - start;
  found = 0;
  for (const auto& hit : hits) found += hit.hit.geomID != RTC_INVALID_GEOMETRY_ID;
  return seconds;
}

double Embree::occluded(const RaySet& set, std::size_t& found) const {
  std::vector<RTCRay> tested;
  for (std::size_t n = 0; n < set.rays.size(); ++n) tested.push_back(ray_of(set.rays[n], set.t_max[n]));
  RTCIntersectContext context = context_for(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
  const double start = thread_seconds();
  for (auto& ray : tested) rtcOccluded1(parts_->scene, &context, &ray);
  const double seconds = thread_seconds() - start;
  found = 0;
  for (const auto& ray : tested) found += ray.tfar < 0;
  return seconds;
}

}  // namespace orrery::bench
