#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/math/bounds.h"
#include "core/math/exposure.h"
#include "core/model/asset_source.h"
#include "core/model/packet.h"

// Shapes. A scene keeps all shapes of one type together (a ShapeSet, in double precision); for rendering each
// set makes a ShapeKernel in the plan's number type, whose calls take whole batches.
namespace orrery {

class Params;

// The surface of one shape at one hit.
template <class N>
struct Surface {
  Vec3<N> position;   // on the shape, to the last few ulp
  Vec3<N> geometric;  // outward unit normal
  Vec3<N> normal;     // outward unit normal for shading
  N magnitude;  // largest absolute coordinate of the shape, at least near the hit: the scale of rounding
};

// Where on its shape one hit is.
template <class N>
struct SurfacePoint {
  N u, v;           // the shape's own parameters
  N s, t;           // texture coordinates
  Vec3<N> tangent;  // unit, along which s grows, at right angles to the true normal
};

// Primitives of one kernel in an order that a structure chose, laid out in blocks of kBlock<T>, so that a
// packet meets one of them, or a single ray a block of them, at once. Hits and ties are those of
// ShapeKernel::closest(), bit for bit. A call takes the pairs in their order, with rays and hits at the
// places they name, and counts its work. Const and free of state.
template <class T>
class PackedPrimitives {
 public:
  virtual ~PackedPrimitives() = default;

  using RayBlockPairs = std::span<const RayBlockPair>;
  virtual void closest(RayBlockPairs pairs, const SingleRay<T>* rays, SingleHit<T>* hits,
                       AcceleratorCounts& counts) const = 0;
  virtual void closest(RayBlockPairs pairs, const Packet<T>* packets, PacketHit<T>* hits,
                       AcceleratorCounts& counts) const = 0;
  // Sets t to -1 for rays that meet something in (0, t).
  virtual void occlude(RayBlockPairs pairs, const SingleRay<T>* rays, SingleHit<T>* hits,
                       AcceleratorCounts& counts) const = 0;
  virtual void occlude(RayBlockPairs pairs, const Packet<T>* packets, PacketHit<T>* hits,
                       AcceleratorCounts& counts) const = 0;

  // Has the machine fetch a block that is wanted soon; nothing if that does not pay.
  virtual void prefetch(std::uint32_t /*block*/) const {}

  virtual std::size_t bytes() const = 0;
  // What it was packed from: see ShapeKernel::pack().
  virtual std::vector<int> indices() const = 0;
};
template <class T>
using PackedPrimitivesPtr = std::shared_ptr<const PackedPrimitives<T>>;

inline constexpr int kNothing = -1;  // an empty place in a block

// A triangle of a surface, by its corners.
using HullTriangle = std::array<Vec3d, 3>;

// Const and free of state: any number of threads may call it at once.
template <class T>
class ShapeKernel {
 public:
  virtual ~ShapeKernel() = default;

  // Tests primitive `index` of this set against the rays of `groups`; a hit in (0, hits.t) replaces the one
  // there. At equal t the lower primitive number stays. Counts what is tested within the primitive, not that
  // it is one.
  virtual void closest(int index, const RayBatch<T>& rays, const Groups& groups, HitBatch<T>& hits,
                       AcceleratorCounts& counts) const = 0;

  // Sets t_max to -1 for the rays of `groups` that meet primitive `index` in (0, t_max). Counts likewise.
  virtual void occlude(int index, RayBatch<T>& rays, const Groups& groups,
                       AcceleratorCounts& counts) const = 0;

  // A surface whose convex hull holds a bounded primitive but for rounding, or nothing if its box along the
  // axes tells as much.
  virtual std::vector<HullTriangle> hull(int index) const = 0;

  // Whether its primitives stand where they are at the rays' time.
  virtual bool timed() const { return false; }

  // The primitives with these indices, in this order, or kNothing, as many as fill whole blocks. No block is
  // empty. They do not refer to the kernel afterwards. REQUIRES: !timed().
  virtual PackedPrimitivesPtr<T> pack(std::span<const int> indices) const = 0;

  // Fills the surface of every hit in `groups` that belongs to this set, other lanes stay as they are.
  virtual void surface(const RayBatch<T>& rays, const HitBatch<T>& hits, const Groups& groups,
                       SurfaceBatch<T>& out) const = 0;

  // Fills u and v of hits and surfaces and the tangent, likewise. REQUIRES: surface() was called before.
  virtual void parameters(const RayBatch<T>& rays, const Groups& groups, HitBatch<T>& hits,
                          SurfaceBatch<T>& out) const = 0;
};

template <class T>
using ShapeKernelPtr = std::shared_ptr<const ShapeKernel<T>>;

// What the plan may use about a shape.
struct ShapeTraits {
  bool convex = false;  // encloses a convex body, or is flat: it cannot shadow or mirror itself outside
  bool closed = false;  // has an inside
};

// A surface from whose points light can be drawn.
struct Patch {
  enum class Kind { rectangle, triangle, disk, sphere, box, cylinder } kind;
  // Rectangle: a corner and two sides at right angles. Triangle: a corner and two sides. Disk: its centre and
  // two radii at right angles. Sphere: its centre, and the radius in a.x. Box: its centre and half of its
  // edges, at right angles. Cylinder with ends: its centre, two radii and half of its axis, likewise.
  Vec3d at, a, b, c{};
};

// The primitives of a set that move, during an exposure. Const and free of state.
class MovingShapes {
 public:
  virtual ~MovingShapes() = default;

  // Where a primitive gets, also as rays of either precision see it. REQUIRES: it moves.
  virtual Boundsd bounds(int index) const = 0;
  // Timed kernels of those that move. Primitives have the numbers that they have in the set, from `first` on.
  virtual ShapeKernelPtr<float> kernel(float, int first) const = 0;
  virtual ShapeKernelPtr<double> kernel(double, int first) const = 0;
};

class ShapeSet {
 public:
  virtual ~ShapeSet() = default;

  // Reads one object; returns how many primitives it added.
  virtual int add(Params& params, MeshSource& meshes) = 0;
  virtual int size() const = 0;
  // Primitives that were not added because no ray can meet them.
  virtual std::size_t left_out() const { return 0; }
  // When its primitives are told to be where, in seconds; empty if they rest.
  virtual std::vector<double> key_times() const { return {}; }
  // The same primitives in the same order as they stand at `time`; null if they rest.
  virtual std::unique_ptr<ShapeSet> at(double /*time*/) const { return nullptr; }
  // Those that move, during an exposure that is no instant; null if all rest. Refers to the set.
  virtual std::unique_ptr<MovingShapes> during(const Exposure&) const { return nullptr; }
  virtual bool moves(int /*index*/) const { return false; }
  // Infinite sides where the primitive is unbounded.
  virtual Boundsd bounds(int index) const = 0;
  // Where the primitive gets while it moves, and how small its box is at the least of its keys.
  struct Reach {
    Boundsd box;
    double least_diagonal = std::numeric_limits<double>::infinity();
  };
  virtual Reach reach(int index) const {
    const Boundsd box = bounds(index);
    return {box, box.diagonal()};
  }
  // Largest absolute coordinate of the point that places an unbounded primitive; 0 of others.
  virtual double anchor_magnitude(int /*index*/) const { return 0; }
  virtual ShapeTraits traits() const = 0;
  // The primitive's whole surface, if light can be drawn from it.
  virtual std::optional<Patch> patch(int /*index*/) const { return std::nullopt; }

  // Kernels whose primitives are numbered from `first`. They do not refer to the set afterwards.
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
