#include <embree3/rtcore.h>
#include <time.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <numbers>
#include <random>
#include <string>

#include "core/accelerators/registry.h"
#include "core/load/load.h"
#include "core/render/prepare.h"

// Our hierarchy beside Embree's: the same mesh, the same rays, one thread, runs in turn.
//   bench_embree TRIANGLES PAIRS [default|robust]
// Prints a JSON line a comparison: CPU seconds of each pair of runs.
namespace orrery {
namespace {

double cpu_seconds() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// ---- the mesh: a sphere with bumps of several sizes

struct Mesh {
  std::vector<Vec3f> positions;
  std::vector<std::array<unsigned, 3>> triangles;
};

Mesh bumpy_sphere(int triangles) {
  const int side = std::max(3, static_cast<int>(std::sqrt(triangles / 2.0)));
  Mesh mesh;
  for (int row = 0; row <= side; ++row) {
    for (int column = 0; column < side; ++column) {
      const double polar = std::numbers::pi * row / side, around = 2 * std::numbers::pi * column / side;
      const double bumps = 0.1 * std::sin(5 * polar) * std::cos(4 * around) +
                           0.03 * std::sin(31 * polar) * std::cos(24 * around) +
                           0.01 * std::cos(83 * polar + 40 * around);
      const double radius = 1 + bumps * std::sin(polar);
      mesh.positions.push_back(
          Vec3f(Vec3d(radius * std::sin(polar) * std::cos(around), radius * std::cos(polar),
                      radius * std::sin(polar) * std::sin(around))));
    }
  }
  const auto at = [&](int row, int column) { return static_cast<unsigned>(row * side + column % side); };
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      if (row > 0) mesh.triangles.push_back({at(row, column), at(row, column + 1), at(row + 1, column)});
      if (row + 1 < side)
        mesh.triangles.push_back({at(row, column + 1), at(row + 1, column + 1), at(row + 1, column)});
    }
  }
  return mesh;
}

std::string scene_json(const Mesh& mesh) {
  std::string json =
      R"({"version": 1, "camera": {"type": "perspective", "eye": [0, 0, 5], "look_at": [0, 0, 0]},
    "materials": {"m": {"type": "rough"}}, "lights": [{"type": "directional", "from": [1, 1, 1]}],
    "objects": [{"type": "mesh", "material": "m", "positions": [)";
  char text[96];
  const char* comma = "";
  for (const Vec3f& p : mesh.positions) {
    std::snprintf(text, sizeof text, "%s[%.9g,%.9g,%.9g]", comma, p.x, p.y, p.z);
    json += text;
    comma = ",";
  }
  json += "], \"indices\": [";
  comma = "";
  for (const auto& t : mesh.triangles) {
    std::snprintf(text, sizeof text, "%s[%u,%u,%u]", comma, t[0], t[1], t[2]);
    json += text;
    comma = ",";
  }
  return json + "]}]}";
}

// ---- the rays

constexpr int kSide = 768;
using Rays = std::vector<Ray<float>>;

// Blocks of 4 x 4 pixels follow each other.
Rays primary_rays() {
  const Vec3f eye(0.7f, 0.9f, 2.6f);
  const Vec3f back = normalize(eye), right = normalize(cross(Vec3f(0, 1, 0), back)), up = cross(back, right);
  Rays rays;
  for (int block = 0; block < kSide * kSide / 16; ++block) {
    for (int i = 0; i < 16; ++i) {
      const int x = block % (kSide / 4) * 4 + i % 4, y = block / (kSide / 4) * 4 + i / 4;
      const float u = (static_cast<float>(x) + 0.5f) / kSide - 0.5f,
                  v = (static_cast<float>(y) + 0.5f) / kSide - 0.5f;
      rays.push_back({eye, normalize(right * u + up * v - back)});
    }
  }
  return rays;
}

using Batches = std::vector<RayBatch<float>>;

Batches batches_of(const Rays& rays, float t_max) {
  Batches batches((rays.size() + kBatch - 1) / kBatch);
  for (auto& batch : batches) {
    for (int i = 0; i < kBatchRoom; ++i) {
      batch.t_max[i] = -1;
      batch.direction.z[i] = 1;
    }
  }
  for (std::size_t n = 0; n < rays.size(); ++n) {
    RayBatch<float>& batch = batches[n / kBatch];
    const int i = batch.count++;
    batch.origin.x[i] = rays[n].origin.x, batch.origin.y[i] = rays[n].origin.y,
    batch.origin.z[i] = rays[n].origin.z;
    batch.direction.x[i] = rays[n].direction.x, batch.direction.y[i] = rays[n].direction.y,
    batch.direction.z[i] = rays[n].direction.z;
    batch.t_max[i] = t_max;
  }
  return batches;
}

// ---- the sides

using Hits = std::vector<HitBatch<float>>;

struct Ours {
  const Accelerator<float>& accelerator;
  AcceleratorCounts counts{};

  Hits hits_for(const Batches& batches) const {
    Hits hits(batches.size());
    for (std::size_t b = 0; b < hits.size(); ++b) {
      hits[b].t = batches[b].t_max;
      hits[b].primitive.values.fill(kNoPrimitive);
    }
    return hits;
  }
  double closest(const Batches& batches, Hits& hits) {
    hits = hits_for(batches);
    const double start = cpu_seconds();
    for (std::size_t b = 0; b < batches.size(); ++b)
      accelerator.closest(batches[b], Groups::covering(0, batches[b].count, kWidth<float>), hits[b], counts);
    return cpu_seconds() - start;
  }
  double occlude(Batches batches, std::uint64_t& occluded) {
    const double start = cpu_seconds();
    for (auto& batch : batches)
      accelerator.occlude(batch, Groups::covering(0, batch.count, kWidth<float>), counts);
    const double seconds = cpu_seconds() - start;
    occluded = 0;
    for (const auto& batch : batches)
      for (int i = 0; i < batch.count; ++i) occluded += batch.t_max[i] < 0;
    return seconds;
  }
};

struct Theirs {
  RTCDevice device = rtcNewDevice("threads=1");
  RTCScene scene = nullptr;
  double build_s = 0;

  Theirs(const Mesh& mesh, bool robust, RTCBuildQuality quality) {
    scene = rtcNewScene(device);
    rtcSetSceneBuildQuality(scene, quality);
    if (robust) rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12,
                                             mesh.positions.size());
    std::memcpy(vertices, mesh.positions.data(), 12 * mesh.positions.size());
    void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12,
                                            mesh.triangles.size());
    std::memcpy(indices, mesh.triangles.data(), 12 * mesh.triangles.size());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    const double start = cpu_seconds();
    rtcCommitScene(scene);
    build_s = cpu_seconds() - start;
  }
  ~Theirs() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  Theirs(const Theirs&) = delete;

  static RTCIntersectContext context(bool coherent) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return context;
  }

  double closest16(const Rays& rays) {
    std::vector<RTCRayHit16> packets(rays.size() / 16);
    for (std::size_t n = 0; n < packets.size() * 16; ++n) {
      RTCRayHit16& p = packets[n / 16];
      const std::size_t i = n % 16;
      p.ray.org_x[i] = rays[n].origin.x, p.ray.org_y[i] = rays[n].origin.y, p.ray.org_z[i] = rays[n].origin.z;
      p.ray.dir_x[i] = rays[n].direction.x, p.ray.dir_y[i] = rays[n].direction.y,
      p.ray.dir_z[i] = rays[n].direction.z;
      p.ray.tnear[i] = 0, p.ray.tfar[i] = std::numeric_limits<float>::infinity();
      p.ray.mask[i] = ~0u, p.ray.flags[i] = 0, p.ray.time[i] = 0, p.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
    alignas(64) int valid[16];
    std::fill(valid, valid + 16, -1);
    RTCIntersectContext how = context(true);
    const double start = cpu_seconds();
    for (auto& packet : packets) rtcIntersect16(valid, scene, &how, &packet);
    return cpu_seconds() - start;
  }

  static RTCRay ray_of(const Ray<float>& ray, float t_max) {
    return {ray.origin.x,
            ray.origin.y,
            ray.origin.z,
            0,
            ray.direction.x,
            ray.direction.y,
            ray.direction.z,
            0,
            t_max,
            ~0u,
            0,
            0};
  }
  double closest1(const Rays& rays, std::vector<RTCRayHit>& hits) {
    hits.assign(rays.size(), {});
    for (std::size_t n = 0; n < rays.size(); ++n) {
      hits[n].ray = ray_of(rays[n], std::numeric_limits<float>::infinity());
      hits[n].hit.geomID = RTC_INVALID_GEOMETRY_ID;
    }
    RTCIntersectContext how = context(false);
    const double start = cpu_seconds();
    for (auto& hit : hits) rtcIntersect1(scene, &how, &hit);
    return cpu_seconds() - start;
  }
  double occluded1(const Rays& rays, float t_max, std::uint64_t& occluded) {
    std::vector<RTCRay> tested;
    for (const auto& ray : rays) tested.push_back(ray_of(ray, t_max));
    RTCIntersectContext how = context(false);
    const double start = cpu_seconds();
    for (auto& ray : tested) rtcOccluded1(scene, &how, &ray);
    const double seconds = cpu_seconds() - start;
    occluded = 0;
    for (const auto& ray : tested) occluded += ray.tfar < 0;
    return seconds;
  }
};

// One cosine-weighted ray from each primary hit, off the surface.
Rays bounce_rays(const Mesh& mesh, const Rays& primary, const Hits& hits) {
  std::mt19937 random(1);
  std::normal_distribution<float> normal_number;
  Rays rays;
  for (std::size_t n = 0; n < primary.size(); ++n) {
    const auto& batch = hits[n / kBatch];
    const int i = static_cast<int>(n % kBatch);
    if (batch.primitive[i] == kNoPrimitive) continue;
    const auto& t = mesh.triangles[static_cast<std::size_t>(batch.primitive[i])];
    const Vec3f a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
    Vec3f normal = normalize(cross(b - a, c - a));
    if (dot(normal, primary[n].direction) > 0) normal = -normal;
    const Vec3f ball = normalize(Vec3f(normal_number(random), normal_number(random), normal_number(random)));
    const Vec3f direction = normalize(normal + ball * 0.999f);
    rays.push_back({primary[n].at(batch.t[i]) + normal * 1e-4f, direction});
  }
  return rays;
}

struct Row {
  std::string name;
  std::vector<double> ours, theirs;
  double rays = 0;
};

void print(const Row& row, const std::string& extra) {
  const auto list = [](const std::vector<double>& values) {
    std::string text;
    for (const double v : values) text += (text.empty() ? "" : ", ") + std::to_string(v);
    return "[" + text + "]";
  };
  std::printf("{\"name\": \"%s\", \"rays\": %.0f, \"ours\": %s, \"theirs\": %s%s}\n", row.name.c_str(),
              row.rays, list(row.ours).c_str(), list(row.theirs).c_str(), extra.c_str());
  std::fflush(stdout);
}

int run(int triangles, int pairs, bool robust) {
  const Mesh mesh = bumpy_sphere(triangles);
  const auto scene = load_scene(scene_json(mesh));
  const AcceleratorType* type = nullptr;
  for (const auto& t : accelerator_types())
    if (std::string(t.name) == "bvh") type = &t;
  PreparedScene prepared(scene);
  double build_ms = 0;
  const World<float>& world = world_for<float>(prepared.parts(), *type, build_ms);
  Ours ours{*world.accelerator};
  Theirs theirs(mesh, robust, RTC_BUILD_QUALITY_HIGH);

  Row build{"build", {}, {}, 0};
  for (int p = 0; p < pairs; ++p) {
    const double start = cpu_seconds();
    const auto again = orrery::build(*type, world.primitives);
    build.ours.push_back(cpu_seconds() - start);
    build.theirs.push_back(Theirs(mesh, robust, RTC_BUILD_QUALITY_HIGH).build_s);
  }
  print(build, ", \"triangles\": " + std::to_string(mesh.triangles.size()));

  const Rays primary = primary_rays();
  const Batches primary_batches = batches_of(primary, std::numeric_limits<float>::infinity());
  Hits hits;
  std::vector<RTCRayHit> their_hits;
  Row row{"primary", {}, {}, static_cast<double>(primary.size())};
  for (int p = 0; p < pairs; ++p) {
    row.ours.push_back(ours.closest(primary_batches, hits));
    row.theirs.push_back(theirs.closest16(primary));
  }
  print(row, "");

  const Rays bounce = bounce_rays(mesh, primary, hits);
  const Batches bounce_batches = batches_of(bounce, std::numeric_limits<float>::infinity());
  row = {"bounce", {}, {}, static_cast<double>(bounce.size())};
  ours.counts = {};
  for (int p = 0; p < pairs; ++p) {
    row.ours.push_back(ours.closest(bounce_batches, hits));
    row.theirs.push_back(theirs.closest1(bounce, their_hits));
  }
  std::uint64_t differ = 0;
  for (std::size_t n = 0; n < bounce.size(); ++n)
    differ += (hits[n / kBatch].primitive[static_cast<int>(n % kBatch)] == kNoPrimitive) !=
              (their_hits[n].hit.geomID == RTC_INVALID_GEOMETRY_ID);
  const double per_ray = 1.0 / static_cast<double>(bounce.size()) / pairs;
  print(row,
        ", \"differ\": " + std::to_string(differ) +
            ", \"nodes\": " + std::to_string(static_cast<double>(ours.counts.node_visits) * per_ray) +
            ", \"tests\": " + std::to_string(static_cast<double>(ours.counts.primitive_tests) * per_ray));

  constexpr float kReach = 0.5f;
  const Batches shadow_batches = batches_of(bounce, kReach);
  std::uint64_t our_occluded = 0, their_occluded = 0;
  row = {"anyhit", {}, {}, static_cast<double>(bounce.size())};
  for (int p = 0; p < pairs; ++p) {
    row.ours.push_back(ours.occlude(shadow_batches, our_occluded));
    row.theirs.push_back(theirs.occluded1(bounce, kReach, their_occluded));
  }
  print(row,
        ", \"occluded\": [" + std::to_string(our_occluded) + ", " + std::to_string(their_occluded) + "]");
  return 0;
}

}  // namespace
}  // namespace orrery

int main(int count, char** words) {
  if (count < 3) return 2;
  return orrery::run(std::atoi(words[1]), std::atoi(words[2]),
                     count > 3 && std::string(words[3]) == "robust");
}
