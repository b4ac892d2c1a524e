#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cstdio>
#include <map>

#include "core/accelerators/registry.h"
#include "core/base/error.h"
#include "core/prepare/prepared_scene.h"
#include "tests/bench/embree.h"
#include "tests/bench/measuring.h"
#include "tests/bench/rays.h"
#include "tests/support/batches.h"

// Compares orrery's BVH with Embree's on the same mesh and the same rays, on one thread.
//   bench SUBJECT|FILE TRIANGLES open|room default|robust [STRUCTURE]
//   bench list
// Prints facts of both sides as JSON, including the measurement kinds: the kinds of rays, and "build". Then,
// for each input line "ours KIND" or "theirs KIND", runs this side once and prints the CPU seconds.
namespace orrery::bench {
namespace {

constexpr std::size_t kFewestRays = 10'000;  // kinds with fewer rays are skipped

constexpr const char* kScene =
    R"({"version": 1, "camera": {"type": "perspective", "eye": [0, 0, 5], "look_at": [0, 0, 0]},
        "materials": {"m": {"type": "rough"}}, "lights": [{"type": "directional", "direction_to_light": [1, 1, 1]}],
        "objects": [{"type": "mesh", "material": "m", "file": "the mesh"}]})";

OneModel in_memory(const Mesh& mesh) {
  TriangleMesh copy;
  for (const Vec3f& p : mesh.positions) copy.positions.push_back(Vec3d(p));
  for (const auto& t : mesh.triangles) copy.triangles.push_back({t[0], t[1], t[2]});
  return OneModel(model_of(std::move(copy)));
}

class Ours {
 public:
  Ours(const Mesh& mesh, std::string_view structure) : prepared_(load_scene(kScene, in_memory(mesh))) {
    for (const auto& type : accelerator_types())
      if (type.name == structure) type_ = &type;
    if (!type_) throw Error("unknown structure " + std::string(structure));
    double build_ms = 0;
    world_ = world_for<float>(prepared_.parts(), *type_, 0, build_ms);
  }

  AcceleratorFacts facts() const { return world_.accelerator->facts(); }

  double build() const {
    const double start = thread_seconds();
    const auto again = orrery::build(*type_, world_.geometry->primitives);
    return thread_seconds() - start;
  }

  // Returns the CPU seconds. Sets `found` and adds to `counts`.
  double closest(const RaySet& set, Hits& found, AcceleratorCounts& counts) const {
    const auto batches = batches_of(set);
    std::vector<HitBatch<float>> hits(batches.size());
    for (std::size_t b = 0; b < hits.size(); ++b) {
      hits[b].t = batches[b].t_max;
      hits[b].primitive.values.fill(kNoPrimitive);
    }
    const double start = thread_seconds();
    for (std::size_t b = 0; b < batches.size(); ++b)
      world_.accelerator->closest(batches[b], test::groups_of(batches[b]), hits[b], counts);
    const double seconds = thread_seconds() - start;
    found = {};
    for (std::size_t b = 0; b < batches.size(); ++b) {
      for (int i = 0; i < batches[b].count; ++i) {
        found.triangle.push_back(hits[b].primitive[i]);
        found.t.push_back(hits[b].t[i]);
      }
    }
    return seconds;
  }

  double occlude(const RaySet& set, std::size_t& found, AcceleratorCounts& counts) const {
    auto batches = batches_of(set);
    const double start = thread_seconds();
    for (auto& batch : batches) world_.accelerator->occlude(batch, test::groups_of(batch), counts);
    const double seconds = thread_seconds() - start;
    found = 0;
    for (const auto& batch : batches)
      for (int i = 0; i < batch.count; ++i) found += batch.t_max[i] < 0;
    return seconds;
  }

 private:
  static std::vector<RayBatch<float>> batches_of(const RaySet& set) {
    std::vector<RayBatch<float>> batches((set.rays.size() + kBatch - 1) / kBatch);
    test::for_each_batch<float>(set.rays, [&](std::span<const Ray<float>> some, std::size_t from) {
      RayBatch<float>& batch = batches[from / kBatch];
      test::fill_batch(some, 1.0f, batch);
      for (int i = 0; i < batch.count; ++i) batch.t_max[i] = set.t_max[from + static_cast<std::size_t>(i)];
    });
    return batches;
  }

  PreparedScene prepared_;
  const AcceleratorType* type_ = nullptr;
  World<float> world_;
};

// Throws Error if the numbers of hits differ by more than 0.1 % of the rays. Rays that graze an edge may
// differ.
void require_same(const std::string& kind, std::size_t ours, std::size_t theirs, std::size_t rays) {
  const std::size_t differ = ours > theirs ? ours - theirs : theirs - ours;
  if (differ * 1000 > rays)
    throw Error(kind + ": hits differ: ours " + std::to_string(ours) + ", theirs " + std::to_string(theirs) +
                " of " + std::to_string(rays));
}

class Comparison {
 public:
  Comparison(Subject subject, bool robust, std::string_view structure)
      : subject_(std::move(subject)),
        robust_(robust),
        ours_(subject_.mesh, structure),
        theirs_(subject_.mesh, robust) {
    const FindHits find = [this](const RaySet& set) {
      Hits hits;
      AcceleratorCounts counts;
      ours_.closest(set, hits, counts);
      return hits;
    };
    for (const char* kind : ray_kinds()) {
      RaySet set = rays_of(kind, subject_, find);
      if (set.rays.size() >= kFewestRays) rays_.emplace(kind, std::move(set));
    }
  }

  void print_facts() const {
    std::printf(
        "{\"triangles\": %zu, \"our_bytes\": %zu, \"their_bytes\": %zu, \"references\": %zu, \"kinds\": "
        "{\"build\": {}",
        subject_.mesh.triangles.size(), ours_.facts().bytes, theirs_.bytes(), ours_.facts().references);
    for (const auto& [kind, set] : rays_) {
      AcceleratorCounts counts;
      Hits hits;
      std::size_t ours = 0, theirs = 0;
      if (set.any_hit) {
        ours_.occlude(set, ours, counts);
        theirs_.occluded(set, theirs);
      } else {
        ours_.closest(set, hits, counts);
        ours = hits.triangle.size() -
               static_cast<std::size_t>(std::count(hits.triangle.begin(), hits.triangle.end(), kNoPrimitive));
        theirs_.closest(set, theirs);
      }
      require_same(kind, ours, theirs, set.rays.size());
      const auto rays = static_cast<double>(set.rays.size());
      std::printf(", \"%s\": {\"rays\": %zu, \"met\": %.3f, \"visits\": %.3f, \"triangles\": %.3f}",
                  kind.c_str(), set.rays.size(), static_cast<double>(ours) / rays,
                  static_cast<double>(counts.node_visits) / rays,
                  static_cast<double>(counts.primitive_tests) / rays);
    }
    std::printf("}}\n");
    std::fflush(stdout);
  }

  double seconds(bool mine, const std::string& kind) const {
    if (kind == "build") return mine ? ours_.build() : Embree(subject_.mesh, robust_).build_s();
    const RaySet& set = rays_.at(kind);
    Hits hits;
    AcceleratorCounts counts;
    std::size_t found = 0;
    if (set.any_hit) return mine ? ours_.occlude(set, found, counts) : theirs_.occluded(set, found);
    if (mine) return ours_.closest(set, hits, counts);
    return kind == "primary" ? theirs_.closest_in_packets(set) : theirs_.closest(set, found);
  }

 private:
  const Subject subject_;
  const bool robust_;
  Ours ours_;
  Embree theirs_;
  std::map<std::string, RaySet> rays_;
};

int run(const std::vector<std::string>& words) {
  const oneapi::tbb::global_control one_thread(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  Subject subject = subject_of(words[0], std::stoi(words[1]));
  if (words[2] == "room") put_in_room(subject.mesh);
  const Comparison comparison(std::move(subject), words[3] == "robust", words.size() > 4 ? words[4] : "bvh");
  comparison.print_facts();
  for (std::string side, kind; std::cin >> side >> kind;) {
    std::printf("%.9f\n", comparison.seconds(side == "ours", kind));
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace
}  // namespace orrery::bench

int main(int count, char** words) {
  const std::vector<std::string> arguments(words + 1, words + count);
  if (arguments.size() == 1 && arguments[0] == "list") {
    for (const std::string& name : orrery::bench::subject_names()) std::puts(name.c_str());
    return 0;
  }
  if (arguments.size() < 4) return 2;
  return orrery::bench::run(arguments);
}
