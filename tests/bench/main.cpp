#include <oneapi/tbb/global_control.h>

#include <cstdio>

#include "core/accelerators/registry.h"
#include "core/base/error.h"
#include "core/prepare/prepared_scene.h"
#include "tests/bench/embree.h"
#include "tests/bench/measuring.h"
#include "tests/support/batches.h"

// Our hierarchy beside Embree's: the same mesh, the same rays, one thread.
//   bench build|primary|bounce|anyhit TRIANGLES default|robust
// First prints a line about both sides, in JSON; then for each line of input, "ours" or "theirs", runs that
// side once and prints its CPU seconds.
namespace orrery::bench {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kRepeats = 4;     // of a run that is measured as one
constexpr float kReach = 0.5f;  // of occlusion rays, in a sphere of radius 1

constexpr const char* kScene =
    R"({"version": 1, "camera": {"type": "perspective", "eye": [0, 0, 5], "look_at": [0, 0, 0]},
        "materials": {"m": {"type": "rough"}}, "lights": [{"type": "directional", "from": [1, 1, 1]}],
        "objects": [{"type": "mesh", "material": "m", "file": "the mesh"}]})";

class InMemory final : public MeshSource {
 public:
  explicit InMemory(const Mesh& mesh) {
    for (const Vec3f& p : mesh.positions) mesh_.positions.push_back(Vec3d(p));
    for (const auto& t : mesh.triangles) mesh_.triangles.push_back({t[0], t[1], t[2]});
  }
  TriangleMesh file(const std::string&) const override { return mesh_; }

 private:
  TriangleMesh mesh_;
};

class Ours {
 public:
  explicit Ours(const Mesh& mesh) : prepared_(load_scene(kScene, InMemory(mesh))) {
    for (const auto& type : accelerator_types())
      if (std::string_view(type.name) == "bottom-up") type_ = &type;
    double build_ms = 0;
    world_ = world_for<float>(prepared_.parts(), *type_, 0, build_ms);
  }

  std::size_t bytes() const { return world_.accelerator->facts().bytes; }

  double build() const {
    const double start = thread_seconds();
    const auto again = orrery::build(*type_, world_.geometry->primitives);
    return thread_seconds() - start;
  }

  double closest(const Rays& rays, std::vector<int>& triangle, std::vector<float>& t) const {
    const auto batches = batches_of(rays, kInfinity);
    std::vector<HitBatch<float>> hits(batches.size());
    for (std::size_t b = 0; b < hits.size(); ++b) {
      hits[b].t = batches[b].t_max;
      hits[b].primitive.values.fill(kNoPrimitive);
    }
    AcceleratorCounts counts;
    const double start = thread_seconds();
    for (std::size_t b = 0; b < batches.size(); ++b)
      world_.accelerator->closest(batches[b], test::groups_of(batches[b]), hits[b], counts);
    const double seconds = thread_seconds() - start;
    triangle.clear();
    t.clear();
    for (std::size_t b = 0; b < batches.size(); ++b) {
      for (int i = 0; i < batches[b].count; ++i) {
        triangle.push_back(hits[b].primitive[i]);
        t.push_back(hits[b].t[i]);
      }
    }
    return seconds;
  }

  double occlude(const Rays& rays, std::size_t& found) const {
    auto batches = batches_of(rays, kReach);
    AcceleratorCounts counts;
    const double start = thread_seconds();
    for (auto& batch : batches) world_.accelerator->occlude(batch, test::groups_of(batch), counts);
    const double seconds = thread_seconds() - start;
    found = 0;
    for (const auto& batch : batches)
      for (int i = 0; i < batch.count; ++i) found += batch.t_max[i] < 0;
    return seconds;
  }

 private:
  static std::vector<RayBatch<float>> batches_of(const Rays& rays, float t_max) {
    std::vector<RayBatch<float>> batches((rays.size() + kBatch - 1) / kBatch);
    test::for_each_batch<float>(rays, [&](std::span<const Ray<float>> some, std::size_t from) {
      test::fill_batch(some, t_max, batches[from / kBatch]);
    });
    return batches;
  }

  PreparedScene prepared_;
  const AcceleratorType* type_ = nullptr;
  World<float> world_;
};

// Both found as much, but for rays that graze an edge.
void require_same(std::size_t ours, std::size_t theirs, std::size_t rays) {
  const std::size_t differ = ours > theirs ? ours - theirs : theirs - ours;
  if (differ * 10000 > rays)
    throw Error("ours found " + std::to_string(ours) + ", theirs " + std::to_string(theirs));
}

int run(const std::string& kind, int triangles, bool robust) {
  const oneapi::tbb::global_control one_thread(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  const Mesh mesh = bumpy_sphere(triangles);
  const Ours ours(mesh);
  const Embree theirs(mesh, robust);
  const Rays primary = primary_rays();
  std::vector<int> triangle;
  std::vector<float> t;
  ours.closest(primary, triangle, t);
  const Rays bounce = bounce_rays(mesh, primary, triangle, t);
  const auto found_in = [](const std::vector<int>& hits) {
    return hits.size() - static_cast<std::size_t>(std::count(hits.begin(), hits.end(), kNoPrimitive));
  };
  std::size_t our_found = 0, their_found = 0;
  if (kind == "anyhit") {
    ours.occlude(bounce, our_found);
    theirs.occluded(bounce, kReach, their_found);
  } else {
    ours.closest(bounce, triangle, t);
    our_found = found_in(triangle);
    theirs.closest(bounce, their_found);
  }
  require_same(our_found, their_found, bounce.size());
  std::printf("{\"triangles\": %zu, \"rays\": %zu, \"our_bytes\": %zu, \"their_bytes\": %zu}\n",
              mesh.triangles.size(), kind == "primary" ? primary.size() : bounce.size(), ours.bytes(),
              theirs.bytes());
  std::fflush(stdout);
  answer_sides(kRepeats, [&](bool mine) {
    if (kind == "build") return mine ? ours.build() : Embree(mesh, robust).build_s();
    if (kind == "primary")
      return mine ? ours.closest(primary, triangle, t) : theirs.closest_in_packets(primary);
    if (kind == "bounce")
      return mine ? ours.closest(bounce, triangle, t) : theirs.closest(bounce, their_found);
    return mine ? ours.occlude(bounce, our_found) : theirs.occluded(bounce, kReach, their_found);
  });
  return 0;
}

}  // namespace
}  // namespace orrery::bench

int main(int count, char** words) {
  if (count != 4) return 2;
  return orrery::bench::run(words[1], std::atoi(words[2]), std::string_view(words[3]) == "robust");
}
