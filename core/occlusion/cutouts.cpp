#include "core/occlusion/cutouts.h"

#include <bit>
#include <cmath>

namespace orrery {
namespace {

// Opacities of the materials of a scene, evaluated at one hit at a time.
template <class T>
class Opacities {
 public:
  explicit Opacities(const Scene& scene) : cutouts_(scene.cutouts), use_of_(scene.cutouts.size(), -1) {
    for (const TextureUse& use : scene.texture_uses) {
      if (use.slot != kOpacitySlot) continue;
      const PlacedTexture& texture = scene.textures[static_cast<std::size_t>(use.texture)];
      use_of_[static_cast<std::size_t>(use.material)] = static_cast<int>(uses_.size());
      uses_.push_back({use, texture.mapping, texture.texture->kernel(T())});
    }
  }

  bool lets_rays_pass(std::size_t material) const { return cutouts_[material].lets_rays_pass(); }

  // Surface point that a ray may meet, after `passed` others. u and v are its texture coordinates.
  struct Point {
    std::size_t material;
    IndexOf<T> primitive;
    int passed;
    T u, v;
  };
  struct Scratch {
    TexturePoints<T> points;
    Vec3Array<T> value;
  };
  bool meets(const Ray<T>& ray, const Point& point, Scratch& scratch) const {
    const Cutout& cutout = cutouts_[point.material];
    const int use = use_of_[point.material];
    const double opacity =
        use < 0 ? cutout.opacity : textured(uses_[static_cast<std::size_t>(use)], point, scratch);
    return cutout.cutoff ? opacity >= *cutout.cutoff : random(ray, point) < opacity;
  }

 private:
  struct Use {
    TextureUse use;
    TextureMapping mapping;
    TextureKernelPtr<T> kernel;
  };

  static double textured(const Use& use, const Point& point, Scratch& scratch) {
    const TextureMapping& m = use.mapping;
    const double u = m.repeat[0] * static_cast<double>(point.u),
                 v = m.repeat[1] * static_cast<double>(point.v);
    const Vec3d at(m.cosine * u - m.sine * v + m.shift[0], m.sine * u + m.cosine * v + m.shift[1], 0);
    scratch.points.at.put(0, Vec3<Lanes<T>>(Vec3<T>(at)));
    scratch.points.width.put(0, Vec3<Lanes<T>>(Lanes<T>(T(0))));
    use.kernel->evaluate(scratch.points, LaneGroups::single(0), scratch.value);
    return use.use.scale.x * dot(Vec3d(scratch.value[0]), channel_weights(use.use.channel)) +
           use.use.offset.x;
  }

  // Returns a number in [0, 1). Mixes bits as SplitMix64 (Steele, Lea, Flood, "Fast Splittable Pseudorandom
  // Number Generators", OOPSLA 2014).
  static double random(const Ray<T>& ray, const Point& point) {
    std::uint64_t state =
        static_cast<std::uint64_t>(point.primitive) << 16 | static_cast<std::uint64_t>(point.passed);
    const auto mix = [&](T x) {
      const auto bits = std::bit_cast<std::uint64_t>(static_cast<double>(x));
      state += 0x9e3779b97f4a7c15 + (bits << 12 | bits >> 63);  // without the exponent: independent of units
      state = (state ^ (state >> 30)) * 0xbf58476d1ce4e5b9;
      state = (state ^ (state >> 27)) * 0x94d049bb133111eb;
      state ^= state >> 31;
    };
    for (const Vec3<T>& v : {ray.origin, ray.direction}) mix(v.x), mix(v.y), mix(v.z);
    return static_cast<double>(state >> 11) * 0x1p-53;
  }

  std::vector<Cutout> cutouts_;
  std::vector<Use> uses_;
  std::vector<int> use_of_;  // by material: index in uses_, or -1
};

template <class T>
class CutoutAccelerator final : public Accelerator<T> {
 public:
  CutoutAccelerator(std::shared_ptr<const Geometry<T>> geometry, std::shared_ptr<const Accelerator<T>> behind,
                    bool timed)
      : geometry_(std::move(geometry)),
        behind_(std::move(behind)),
        opacities_(*geometry_->scene),
        timed_(timed) {}

  AcceleratorFacts facts() const override { return behind_->facts(); }

  void closest(const RayBatch<T>& rays, const LaneGroups& groups, HitBatch<T>& hits,
               AcceleratorCounts& counts) const override {
    std::unique_ptr<HitBatch<T>> before(new HitBatch<T>);
    for (const int i : groups) {
      before->t.put(i, hits.t.at(i));
      before->primitive.put(i, load_index<T>(hits.primitive, i));
    }
    behind_->closest(rays, groups, hits, counts);
    Search search{rays, groups, hits, *before, nullptr};
    if (!holes_among(search)) return;
    search.walk.reset(new Walk);
    start(search);
    while (pass(search)) trace(search, counts);
  }

  void occlude(RayBatch<T>& rays, const LaneGroups& groups, AcceleratorCounts& counts) const override {
    std::unique_ptr<Array<T>> ends(new Array<T>);
    for (const int i : groups) ends->put(i, rays.t_max.at(i));
    behind_->occlude(rays, groups, counts);
    LaneGroups occluded;
    for (const int i : groups)
      if (any(ends->at(i) > N(T(0)) && rays.t_max.at(i) < N(T(0)))) occluded.add(i);
    if (occluded.empty()) return;
    std::unique_ptr<HitBatch<T>> hits(new HitBatch<T>);
    for (const int i : occluded) {
      const auto mine = ends->at(i) > N(T(0)) && rays.t_max.at(i) < N(T(0));
      rays.t_max.put(i, mine, ends->at(i));
      hits->t.put(i, select(mine, ends->at(i), N(T(-1))));
      hits->primitive.put(i, IndexLanes<T>(IndexOf<T>{kNoPrimitive}));
    }
    closest(rays, occluded, *hits, counts);
    for (const int i : occluded) {
      const auto met = mask_cast<N>(load_index<T>(hits->primitive, i) >= 0);
      rays.t_max.put(i, met, N(T(-1)));
    }
  }

 private:
  using N = Lanes<T>;

  // Rays that go on behind surfaces, and the surfaces that they passed.
  struct Walk {
    RayBatch<T> rays;
    HitBatch<T> hits;
    SurfaceBatch<T> surface;
    Array<T> travelled;  // metres from the origin of the ray to the origin in `rays`
    LaneGroups groups;
    int passed = 0;
    typename Opacities<T>::Scratch scratch;
  };
  struct Search {
    const RayBatch<T>& rays;
    const LaneGroups& groups;
    HitBatch<T>& hits;
    const HitBatch<T>& before;  // hits before the search, which nearer hits replace
    std::unique_ptr<Walk> walk;
  };

  // Returns whether the hit in a lane is new and on a material that lets rays pass.
  bool may_pass(const Search& search, int lane) const {
    const IndexOf<T> primitive = search.hits.primitive[lane];
    return search.rays.t_max[lane] > 0 && primitive >= 0 && primitive != search.before.primitive[lane] &&
           opacities_.lets_rays_pass(material_of(primitive));
  }
  std::size_t material_of(IndexOf<T> primitive) const {
    return static_cast<std::size_t>(geometry_->material_of[static_cast<std::size_t>(primitive)]);
  }
  bool holes_among(const Search& search) const {
    for (const int i : search.groups)
      for (int lane = i; lane < i + kWidth<T>; ++lane)
        if (may_pass(search, lane)) return true;
    return false;
  }

  // Sets the rays of the walk to the rays of the search. Only lanes whose hit may be passed are active.
  void start(Search& search) const {
    Walk& walk = *search.walk;
    walk.rays.count = search.rays.count;
    for (const int i : search.groups) {
      bool open = false;
      for (int lane = i; lane < i + kWidth<T>; ++lane) {
        const bool mine = may_pass(search, lane);
        walk.rays.t_max[lane] = mine ? search.rays.t_max[lane] : T(-1);
        open |= mine;
      }
      if (!open) continue;
      walk.groups.add(i);
      walk.rays.origin.put(i, search.rays.origin.at(i));
      walk.rays.direction.put(i, search.rays.direction.at(i));
      if (timed_) walk.rays.time.put(i, search.rays.time.at(i));
      walk.travelled.put(i, N(T(0)));
      walk.hits.t.put(i, search.hits.t.at(i));
      walk.hits.primitive.put(i, load_index<T>(search.hits.primitive, i));
    }
  }

  // Moves the rays that pass their surface behind it. Ends the others. Returns whether any ray goes on.
  bool pass(Search& search) const {
    Walk& walk = *search.walk;
    if (++walk.passed > kMaxPassed) return false;
    for (const auto& shapes : geometry_->shapes)
      shapes->surface(walk.rays, walk.hits, walk.groups, walk.surface);
    for (const auto& shapes : geometry_->shapes)
      shapes->parameters(walk.rays, walk.groups, walk.hits, walk.surface);
    LaneGroups open;
    for (const int i : walk.groups) {
      bool goes_on = false;
      for (int lane = i; lane < i + kWidth<T>; ++lane) goes_on |= pass_lane(search, lane);
      if (goes_on) open.add(i);
    }
    walk.groups = open;
    return !open.empty();
  }
  bool pass_lane(Search& search, int lane) const {
    Walk& walk = *search.walk;
    if (!(walk.rays.t_max[lane] > 0)) return false;
    const IndexOf<T> primitive = walk.hits.primitive[lane];
    const std::size_t material = material_of(primitive);
    if (!opacities_.lets_rays_pass(material) ||
        opacities_.meets(search.rays[lane],
                         {material, primitive, walk.passed, walk.surface.u[lane], walk.surface.v[lane]},
                         walk.scratch)) {
      walk.rays.t_max[lane] = -1;  // the hit is in search.hits
      return false;
    }
    const Vec3<T> direction = walk.rays.direction[lane],
                  origin =
                      walk.surface.position[lane] - walk.surface.geometric[lane] * walk.surface.step[lane];
    const T travelled = dot(origin - search.rays.origin[lane], direction),
            left = search.before.t[lane] - travelled;
    search.hits.t[lane] = search.before.t[lane];
    search.hits.primitive[lane] = search.before.primitive[lane];
    walk.rays.origin.set(lane, origin);
    walk.travelled[lane] = travelled;
    walk.rays.t_max[lane] = left > 0 ? left : T(-1);
    return left > 0;
  }

  // Finds the next hits of the rays that go on.
  void trace(Search& search, AcceleratorCounts& counts) const {
    Walk& walk = *search.walk;
    for (const int i : walk.groups) {
      walk.hits.t.put(i, walk.rays.t_max.at(i));
      walk.hits.primitive.put(i, IndexLanes<T>(IndexOf<T>{kNoPrimitive}));
    }
    behind_->closest(walk.rays, walk.groups, walk.hits, counts);
    for (const int i : walk.groups)
      for (int lane = i; lane < i + kWidth<T>; ++lane) {
        if (!(walk.rays.t_max[lane] > 0)) continue;
        if (walk.hits.primitive[lane] < 0) {
          walk.rays.t_max[lane] = -1;
          continue;
        }
        search.hits.t[lane] = walk.travelled[lane] + walk.hits.t[lane];
        search.hits.primitive[lane] = walk.hits.primitive[lane];
      }
  }

  const std::shared_ptr<const Geometry<T>> geometry_;
  const std::shared_ptr<const Accelerator<T>> behind_;
  const Opacities<T> opacities_;
  const bool timed_;
};

}  // namespace

template <class T>
std::shared_ptr<const Accelerator<T>> with_cutouts(std::shared_ptr<const Geometry<T>> geometry,
                                                   std::shared_ptr<const Accelerator<T>> behind, bool timed) {
  return std::make_shared<CutoutAccelerator<T>>(std::move(geometry), std::move(behind), timed);
}

template std::shared_ptr<const Accelerator<float>> with_cutouts(std::shared_ptr<const Geometry<float>>,
                                                                std::shared_ptr<const Accelerator<float>>,
                                                                bool);
template std::shared_ptr<const Accelerator<double>> with_cutouts(std::shared_ptr<const Geometry<double>>,
                                                                 std::shared_ptr<const Accelerator<double>>,
                                                                 bool);

}  // namespace orrery
