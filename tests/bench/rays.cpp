#include "tests/bench/rays.h"

#include <array>
#include <limits>
#include <random>

namespace orrery::bench {
namespace {

constexpr int kSide = 512;      // pixels
constexpr float kReach = 0.5f;  // length of short rays
constexpr float kInfinity = std::numeric_limits<float>::infinity();

RaySet primary_rays(const Vec3f& eye) {
  const Vec3f back = normalize(eye), right = normalize(cross(Vec3f(0, 1, 0), back)), up = cross(back, right);
  RaySet set;
  for (int block = 0; block < kSide * kSide / 16; ++block) {
    for (int i = 0; i < 16; ++i) {
      const int x = block % (kSide / 4) * 4 + i % 4, y = block / (kSide / 4) * 4 + i / 4;
      const float u = (static_cast<float>(x) + 0.5f) / kSide - 0.5f,
                  v = (static_cast<float>(y) + 0.5f) / kSide - 0.5f;
      set.rays.push_back({eye, normalize(right * u + up * v - back)});
    }
  }
  set.t_max.assign(set.rays.size(), kInfinity);
  return set;
}

// Calls make(next, point, normal) for each hit to add a ray. The point is just above the surface. The normal
// is on the side of the incoming ray.
template <class Make>
RaySet from_hits(const Mesh& mesh, const RaySet& rays, const Hits& hits, const Make& make) {
  RaySet next;
  for (std::size_t n = 0; n < rays.rays.size(); ++n) {
    if (hits.triangle[n] == kNoPrimitive) continue;
    const auto& [i, j, k] = mesh.triangles[static_cast<std::size_t>(hits.triangle[n])];
    const Vec3f a = mesh.positions[i], b = mesh.positions[j], c = mesh.positions[k];
    Vec3f normal = normalize(cross(b - a, c - a));
    if (dot(normal, rays.rays[n].direction) > 0) normal = -normal;
    make(next, rays.rays[n].at(hits.t[n]) + normal * 1e-4f, normal);
  }
  return next;
}

}  // namespace

std::span<const char* const> ray_kinds() {
  static constexpr std::array kKinds{"primary", "bounce", "bounce-4", "point", "area", "short"};
  return kKinds;
}

RaySet rays_of(const std::string& kind, const Subject& subject, const FindHits& find) {
  std::mt19937 random(1);
  std::normal_distribution<float> normal_number;
  std::uniform_real_distribution<float> part(-0.5f, 0.5f);
  const auto cosine_ray = [&](float t_max) {
    return [&, t_max](RaySet& out, const Vec3f& at, const Vec3f& normal) {
      const Vec3f ball =
          normalize(Vec3f(normal_number(random), normal_number(random), normal_number(random)));
      out.rays.push_back({at, normalize(normal + ball * 0.999f)});
      out.t_max.push_back(t_max);
    };
  };
  const auto light_ray = [&](float size) {
    return [&, size](RaySet& out, const Vec3f& at, const Vec3f& normal) {
      const Vec3f way = subject.light + Vec3f(size * part(random), 0, size * part(random)) - at;
      if (dot(way, normal) <= 0) return;
      const float distance = length(way);
      out.rays.push_back({at, way * (1 / distance)});
      out.t_max.push_back(distance * 0.9999f);
    };
  };
  RaySet rays = primary_rays(subject.eye);
  if (kind == "primary") return rays;
  const auto next = [&](const auto& make) { return from_hits(subject.mesh, rays, find(rays), make); };
  if (kind == "bounce" || kind == "bounce-4") {
    for (int left = kind == "bounce" ? 1 : 4; left > 0; --left) rays = next(cosine_ray(kInfinity));
    return rays;
  }
  RaySet shadow = kind == "point"  ? next(light_ray(0))
                  : kind == "area" ? next(light_ray(subject.light_size))
                                   : next(cosine_ray(kReach));
  shadow.any_hit = true;
  return shadow;
}

}  // namespace orrery::bench
