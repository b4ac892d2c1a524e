#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/math/bounds.h"
#include "core/math/exposure.h"
#include "core/model/occupied_space.h"
#include "core/model/packet.h"

// Shapes. A scene stores all shapes of one type in a ShapeSet, in double precision. For rendering, each set
// creates a ShapeKernel in the plan's number type. Kernel functions process whole batches.
namespace orrery {

struct MeshSource;
class Params;
struct Tessellation;
struct TessellationView;

// Surface of one shape at one hit.
template <class N>
struct Surface {
  Vec3<N> position;   // on the shape, to within a few ulp
  Vec3<N> geometric;  // outward unit normal
  Vec3<N> normal;     // outward unit normal for shading
  N magnitude;        // largest absolute coordinate near the hit, the scale of rounding errors
};

// Values of ShapeKernel::smooth() at one hit.
template <class N>
struct SmoothSurface {
  Vec3<N> normal;  // unit, on the viewer's side
  Vec3<N> lift;    // metres
};

// Parameters of one hit on its shape.
template <class N>
struct SurfacePoint {
  N u, v;           // parameters of the shape
  N s, t;           // texture coordinates
  Vec3<N> tangent;  // unit, direction of increasing s, perpendicular to the geometric normal
};

// Primitives of one kernel in traversal order, in blocks of kBlock<T>. A packet is tested with one primitive
// at a time, a single ray with a whole block. Hits, including ties, equal those of ShapeKernel::closest() bit
// for bit. A call processes the pairs in order. Each pair indexes `rays` or `packets`, and `hits`. Immutable
// and thread-safe.
template <class T>
class PackedPrimitives {
 public:
  virtual ~PackedPrimitives() = default;

  using RayBlockPairs = std::span<const RayBlockPair>;
  virtual void closest(RayBlockPairs pairs, const SingleRay<T>* rays, SingleHit<T>* hits,
                       AcceleratorCounts& counts) const = 0;
  virtual void closest(RayBlockPairs pairs, const Packet<T>* packets, PacketHit<T>* hits,
                       AcceleratorCounts& counts) const = 0;
  // Sets t to -1 for rays that hit a primitive in (0, t).
  virtual void occlude(RayBlockPairs pairs, const SingleRay<T>* rays, SingleHit<T>* hits,
                       AcceleratorCounts& counts) const = 0;
  virtual void occlude(RayBlockPairs pairs, const Packet<T>* packets, PacketHit<T>* hits,
                       AcceleratorCounts& counts) const = 0;

  // Prefetches a block into the CPU cache. Does nothing for types that do not gain from prefetching.
  virtual void prefetch(std::uint32_t /*block*/) const {}

  virtual std::size_t bytes() const = 0;
  // Returns the indices that were passed to ShapeKernel::pack().
  virtual std::vector<int> indices() const = 0;
};
template <class T>
using PackedPrimitivesPtr = std::shared_ptr<const PackedPrimitives<T>>;

inline constexpr int kNothing = -1;  // index of an empty entry of a block

// Corners of one triangle of a hull.
using HullTriangle = std::array<Vec3d, 3>;

// Intersection functions of all shapes of one type. Immutable and thread-safe.
template <class T>
class ShapeKernel {
 public:
  virtual ~ShapeKernel() = default;

  // Tests primitive `index` of this set against the rays of `groups`. A hit in (0, hits.t) replaces the
  // previous hit. At equal t, the lower primitive number wins. Adds tests inside an instance to `counts`, but
  // not the test of the primitive itself.
  virtual void closest(int index, const RayBatch<T>& rays, const LaneGroups& groups, HitBatch<T>& hits,
                       AcceleratorCounts& counts) const = 0;

  // Sets t_max to -1 for the rays of `groups` that hit primitive `index` in (0, t_max). Counts tests as
  // closest() does.
  virtual void occlude(int index, RayBatch<T>& rays, const LaneGroups& groups,
                       AcceleratorCounts& counts) const = 0;

  // Returns triangles whose convex hull contains a bounded primitive, up to rounding. Returns an empty list
  // if the axis-aligned box is as tight.
  virtual std::vector<HullTriangle> hull(int index) const = 0;

  // Returns true if the primitives depend on the time of the ray.
  virtual bool timed() const { return false; }

  // Packs the primitives with these indices in this order. The index kNothing is an empty entry. The result
  // may outlive the kernel. REQUIRES: `indices` fill whole blocks, no block is empty, and !timed().
  virtual PackedPrimitivesPtr<T> pack(std::span<const int> indices) const = 0;

  // Fills the surface of every hit in `groups` on this set. Other lanes are unchanged.
  virtual void surface(const RayBatch<T>& rays, const HitBatch<T>& hits, const LaneGroups& groups,
                       SurfaceBatch<T>& out) const = 0;

  // Fills u and v of hits and surfaces, and the tangent. Other lanes are unchanged. REQUIRES: surface() was
  // called before.
  virtual void parameters(const RayBatch<T>& rays, const LaneGroups& groups, HitBatch<T>& hits,
                          SurfaceBatch<T>& out) const = 0;

  // Fills `smooth` and `lift` of hits on triangles with vertex normals. Other lanes are unchanged. For
  // vertices V with unit normals n toward the viewer and weights b at position P, the lift is the sum of b
  // max(0, -dot(P - V, n)) n (Hanika, "Hacking the Shadow Terminator", Ray Tracing Gems II, 2021).
  virtual void smooth(const RayBatch<T>& /*rays*/, const HitBatch<T>& /*hits*/, const LaneGroups& /*groups*/,
                      SurfaceBatch<T>& /*out*/) const {}

  // Fills `color` of hits on triangles with vertex colours. Other lanes are unchanged.
  virtual void colors(const RayBatch<T>& /*rays*/, const HitBatch<T>& /*hits*/, const LaneGroups& /*groups*/,
                      SurfaceBatch<T>& /*out*/) const {}
};

template <class T>
using ShapeKernelPtr = std::shared_ptr<const ShapeKernel<T>>;

// Properties of a shape type that the plan uses.
struct ShapeTraits {
  bool convex = false;      // convex or flat: the outside cannot shadow or reflect itself
  bool closed = false;      // has an inside
  bool half_space = false;  // unbounded, with an inside and an outside
  bool smooth = false;      // ShapeKernel::smooth() may set lanes
};

// Surface formed by the primitives `index` to `last` - 1 of a set, where `index` is its first primitive.
struct Shell {
  int last;
  bool closed;  // separates an inside from the outside
};

// Surface on which light sampling can choose points.
struct Patch {
  enum class Kind { rectangle, triangle, disk, sphere, box, cylinder } kind;
  // Rectangle: a corner and two perpendicular sides. Triangle: a corner and two sides. Disk: centre and two
  // perpendicular radii. Sphere: centre, and the radius in a.x. Box: centre and the halves of three
  // perpendicular edges. Cylinder with ends: centre, two radii and half of the axis, all perpendicular.
  Vec3d at, a, b, c{};
};

// Primitives of a set that move during an exposure. Immutable and thread-safe.
class MovingShapes {
 public:
  virtual ~MovingShapes() = default;

  // Returns the bounds over the whole motion, valid for float and double rays. REQUIRES: the primitive moves.
  virtual Boundsd bounds(int index) const = 0;
  // Returns a timed kernel of the moving primitives. Primitive `index` of the set has the number `first` +
  // `index`.
  virtual ShapeKernelPtr<float> kernel(float, int first) const = 0;
  virtual ShapeKernelPtr<double> kernel(double, int first) const = 0;
};

// All shapes of one type. add() is called by one thread while the scene is loaded, records problems in
// `params`, and throws Cancelled. The other functions are thread-safe afterwards. at() and kernel() throw
// Cancelled.
class ShapeSet {
 public:
  virtual ~ShapeSet() = default;

  // Reads one object. Returns the number of added primitives.
  virtual int add(Params& params, MeshSource& meshes) = 0;
  virtual int size() const = 0;
  // Returns the number of primitives omitted because no ray can hit them.
  virtual std::size_t left_out() const { return 0; }
  // Returns the times of the animation keys, in seconds. Returns an empty list if the set is static.
  virtual std::vector<double> key_times() const { return {}; }
  // Returns the same primitives in the same order at `time`, or null if the set is static.
  virtual std::unique_ptr<ShapeSet> at(double /*time*/) const { return nullptr; }
  // Returns the primitives that move during an exposure that is not an instant, or null if none moves. The
  // result must not outlive the set.
  virtual std::unique_ptr<MovingShapes> during(const Exposure&) const { return nullptr; }
  virtual bool moves(int /*index*/) const { return false; }
  // Returns the bounds of a primitive. Unbounded primitives have infinite sides.
  virtual Boundsd bounds(int index) const = 0;
  // Bounds of a primitive over its whole motion, and the smallest diagonal of its box over all animation
  // keys.
  struct SweptBounds {
    Boundsd box;
    double min_diagonal = std::numeric_limits<double>::infinity();
  };
  virtual SweptBounds reach(int index) const {
    const Boundsd box = bounds(index);
    return {box, box.diagonal()};
  }
  // Returns the largest absolute coordinate of the anchor of an unbounded primitive, or 0 if the primitive is
  // bounded.
  virtual double anchor_magnitude(int /*index*/) const { return 0; }
  // Returns a lower bound of the distance from `point` to an unbounded primitive. REQUIRES: the primitive is
  // unbounded.
  virtual double min_distance(int /*index*/, const Vec3d& /*point*/) const { return 0; }
  // Returns the plane that contains an unbounded primitive, or nullopt.
  virtual std::optional<OccupiedSpace::Plane> plane(int /*index*/) const { return std::nullopt; }
  virtual ShapeTraits traits() const = 0;
  // Returns the surface that begins with primitive `index`. Takes time proportional to its size.
  virtual Shell shell(int index) const { return {index + 1, traits().closed || traits().half_space}; }
  // Returns the primitive's whole surface, or nullopt if light cannot be sampled from it.
  virtual std::optional<Patch> patch(int /*index*/) const { return std::nullopt; }

  // Adds triangles that are within view.max_error pixels of the surfaces, as far as
  // Tessellation::kMaxSides permits. Unbounded primitives end where the rest of them covers less than
  // view.max_error pixels. Primitive `index` of the set has the number `first` + `index`. REQUIRES: the set
  // is static. Throws Cancelled.
  virtual void tessellate(const TessellationView& view, int first, Tessellation& out) const = 0;

  // Returns a kernel whose primitives are numbered from `first`. The kernel may outlive the set.
  virtual ShapeKernelPtr<float> kernel(float, int first) const = 0;
  virtual ShapeKernelPtr<double> kernel(double, int first) const = 0;
  virtual ShapeKernelPtr<long double> kernel(long double, int first) const = 0;
};

struct ShapeType {
  const char* name;
  const char* summary;
  std::unique_ptr<ShapeSet> (*make)();
};

}  // namespace orrery
