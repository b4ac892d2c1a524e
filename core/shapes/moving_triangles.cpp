#include "core/shapes/moving_triangles.h"

#include "core/math/motion_segments.h"
#include "core/shapes/mesh_records.h"

namespace orrery {
namespace {

template <class T>
std::vector<Vec3<T>> in_precision(const std::vector<Vec3d>& from) {
  std::vector<Vec3<T>> to;
  to.reserve(from.size());
  for (const Vec3d& v : from) to.push_back(Vec3<T>(v));
  return to;
}

// Returns the largest absolute coordinate of the vertices that triangles use, over all moments.
double magnitude_of(const MovingTriangles& mesh) {
  double magnitude = 0;
  for (const SharedVectors& positions : mesh.positions)
    for (const auto& triangle : mesh.triangles)
      for (const std::uint32_t vertex : triangle)
        magnitude = std::max(magnitude, max_component(abs((*positions)[vertex])));
  return magnitude;
}

// MovingTriangles in the render's precision. Times are fractions of the exposure, in [0, 1).
template <class T>
class Mesh {
 public:
  using N = Lanes<T>;

  explicit Mesh(const MovingTriangles& from)
      : first_(static_cast<int>(from.first)),
        stretches_(from.moments),
        triangles_(from.triangles),
        magnitude_(static_cast<T>(magnitude_of(from))) {
    for (const SharedVectors& positions : from.positions) positions_.push_back(in_precision<T>(*positions));
    for (const auto& normals : from.normals) normals_.push_back(in_precision<T>(normals));
    for (const auto& [u, v] : from.uvs) uvs_.push_back({static_cast<T>(u), static_cast<T>(v)});
  }

  int first() const { return first_; }
  int last() const { return first_ + static_cast<int>(triangles_.size()); }

  // Returns the corners at `time`. Triangles that share a vertex get bit-identical positions for it.
  [[gnu::always_inline]] Corners<N> corners(std::size_t triangle, const N& time) const {
    return between(time, [&, &vertices = triangles_[triangle]](std::size_t moment, std::size_t corner) {
      return positions_[moment][vertices[corner]];
    });
  }

  // Returns the triangle at `time`. REQUIRES: `flat` is the normal of `corners`.
  MeshTriangle<N> record(std::size_t triangle, const Corners<N>& corners, const Vec3<N>& flat,
                         const N& time) const {
    if (normals_.front().empty()) return {corners, {flat, flat, flat}, flat, N(magnitude_)};
    const Corners<N> mixed = between(time, [&](std::size_t moment, std::size_t corner) {
      return normals_[moment][3 * triangle + corner];
    });
    const auto unit = [](const Vec3<N>& v) {
      const N square = dot(v, v);
      using std::sqrt;
      return v * select(square > N(T(0)), N(N(T(1)) / sqrt(square)), N(T(0)));
    };
    return {corners, {unit(mixed.a), unit(mixed.b), unit(mixed.c)}, flat, N(magnitude_)};
  }

  MeshMapping<N> mapping(std::size_t triangle, const Corners<N>& corners) const {
    const N zero(T(0)), one(T(1));
    if (uvs_.empty()) return {corners, {zero, one, zero}, {zero, zero, one}};
    const auto& [a, b, c] = triangles_[triangle];
    return {corners,
            {N(uvs_[a][0]), N(uvs_[b][0]), N(uvs_[c][0])},
            {N(uvs_[a][1]), N(uvs_[b][1]), N(uvs_[c][1])}};
  }

 private:
  // Interpolates at(moment, corner) linearly between the moments around `time`, for each corner.
  template <class At>
  [[gnu::always_inline]] Corners<N> between(const N& time, const At& at) const {
    Corners<N> now{};
    stretches_.for_each(time, [&](const auto& lanes, std::size_t moment, const N& share) {
      const auto mixed = [&](std::size_t corner, const Vec3<N>& others) {
        const Vec3<N> before(at(moment, corner)), after(at(moment + 1, corner));
        return select(lanes, before + (after - before) * share, others);
      };
      now = {mixed(0, now.a), mixed(1, now.b), mixed(2, now.c)};
    });
    return now;
  }

  int first_;
  MotionSegments<T> stretches_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<std::vector<Vec3<T>>> positions_, normals_;
  std::vector<std::array<T, 2>> uvs_;
  T magnitude_;
};

// Returns the unit normal by the right-hand rule, or NaN for a triangle without area. Scales the sides first,
// so that products of tiny sides do not underflow and products of huge sides do not overflow.
template <class N>
Vec3<N> flat_normal(const Corners<N>& corners) {
  const auto side = [&](const Vec3<N>& to) {
    const Vec3<N> difference = to - corners.a;
    return difference / max_component(abs(difference));
  };
  const Vec3<N> e = side(corners.b), f = side(corners.c);
  return normalize(Vec3<N>(difference_of_products(e.y, f.z, e.z, f.y),
                           difference_of_products(e.z, f.x, e.x, f.z),
                           difference_of_products(e.x, f.y, e.y, f.x)));
}

template <class T>
class Kernel final : public ShapeKernel<T> {
 public:
  using N = Lanes<T>;

  Kernel(const std::vector<MovingTriangles>& meshes, int first) : number_(first) {
    for (const MovingTriangles& mesh : meshes) meshes_.emplace_back(mesh);
  }

  bool timed() const override { return true; }
  std::vector<HullTriangle> hull(int) const override { return {}; }
  PackedPrimitivesPtr<T> pack(std::span<const int>) const override { return nullptr; }

  [[gnu::flatten]] void closest(int index, const RayBatch<T>& rays, const LaneGroups& groups,
                                HitBatch<T>& hits, AcceleratorCounts&) const override {
    const Mesh<T>& mesh = *mesh_of(index);
    const IndexLanes<T> id(static_cast<IndexOf<T>>(number_ + index));
    for (const int i : groups) {
      const N best = hits.t.at(i);
      const N t = distance(mesh, index, rays, i, min_first(best, N(std::numeric_limits<T>::max())));
      const auto nearer = is_nearer_hit(t, id, best, load_index<T>(hits.primitive, i));
      if (!any(nearer)) continue;
      hits.t.put(i, nearer, t);
      hits.primitive.put(i, mask_cast<IndexLanes<T>>(nearer), id);
    }
  }

  [[gnu::flatten]] void occlude(int index, RayBatch<T>& rays, const LaneGroups& groups,
                                AcceleratorCounts&) const override {
    const Mesh<T>& mesh = *mesh_of(index);
    for (const int i : groups) {
      const N end = rays.t_max.at(i);
      const auto hit = distance(mesh, index, rays, i, end) < end;
      if (any(hit)) rays.t_max.put(i, hit, N(T(-1)));
    }
  }

  void surface(const RayBatch<T>& rays, const HitBatch<T>& hits, const LaneGroups& groups,
               SurfaceBatch<T>& out) const override {
    for_each_hit(hits, groups, [&](int i, const auto& mine, const Mesh<T>& mesh, std::size_t triangle) {
      const N time = rays.time.at(i);
      const Corners<N> corners = mesh.corners(triangle, time);
      const MeshTriangle<N> record = mesh.record(triangle, corners, flat_normal(corners), time);
      put_surface<T>(record.surface(rays.at(i), hits.t.at(i)), rays.direction.at(i), i, mine, out);
    });
  }

  void smooth(const RayBatch<T>& rays, const HitBatch<T>& hits, const LaneGroups& groups,
              SurfaceBatch<T>& out) const override {
    for_each_hit(hits, groups, [&](int i, const auto& mine, const Mesh<T>& mesh, std::size_t triangle) {
      const N time = rays.time.at(i);
      const Corners<N> corners = mesh.corners(triangle, time);
      put_smooth<T>(mesh.record(triangle, corners, flat_normal(corners), time).smooth(rays.at(i)), i, mine,
                    out);
    });
  }

  void parameters(const RayBatch<T>& rays, const LaneGroups& groups, HitBatch<T>& hits,
                  SurfaceBatch<T>& out) const override {
    for_each_hit(hits, groups, [&](int i, const auto& mine, const Mesh<T>& mesh, std::size_t triangle) {
      const MeshMapping<N> mapping = mesh.mapping(triangle, mesh.corners(triangle, rays.time.at(i)));
      put_parameters<T>(mapping.parameters(rays.at(i), out.position.at(i)), i, mine, hits, out);
    });
  }

 private:
  // Returns the mesh that contains primitive `index`, or null if the primitive is static.
  const Mesh<T>* mesh_of(int index) const {
    const auto mesh = std::upper_bound(meshes_.begin(), meshes_.end(), index,
                                       [](int i, const Mesh<T>& m) { return i < m.last(); });
    return mesh != meshes_.end() && index >= mesh->first() ? &*mesh : nullptr;
  }

  // Returns the distance of the hit, or infinity for a miss. A triangle without area is a miss, although
  // rounding could produce a hit. Distances above `limit` may be returned as infinity.
  [[gnu::always_inline]] static N distance(const Mesh<T>& mesh, int index, const RayBatch<T>& rays, int i,
                                           const N& limit) {
    const Corners<N> corners = mesh.corners(static_cast<std::size_t>(index - mesh.first()), rays.time.at(i));
    const N t = corners.distance(rays.at(i)), infinity(std::numeric_limits<T>::infinity());
    if (!any(t <= limit)) return infinity;
    const Vec3<N> normal = flat_normal(corners);
    return select(dot(normal, normal) > N(T(0)), t, infinity);
  }

  // Calls visit(i, lanes, mesh, triangle) for each register i of `groups` and each moving triangle that some
  // of its lanes hit.
  template <class Visit>
  void for_each_hit(const HitBatch<T>& hits, const LaneGroups& groups, const Visit& visit) const {
    for (const int i : groups) {
      const IndexLanes<T> id = load_index<T>(hits.primitive, i);
      auto open = id >= IndexOf<T>(number_ + meshes_.front().first()) &&
                  id < IndexOf<T>(number_ + meshes_.back().last());
      while (any(open)) {
        const IndexOf<T> one = id[static_cast<std::size_t>(stdx::find_first_set(open))];
        const auto here = open && id == one;
        open = open && !here;
        const int index = static_cast<int>(one) - number_;
        if (const Mesh<T>* mesh = mesh_of(index))
          visit(i, mask_cast<N>(here), *mesh, static_cast<std::size_t>(index - mesh->first()));
      }
    }
  }

  std::vector<Mesh<T>> meshes_;
  int number_;  // number of the set's first primitive
};

class MovingTriangleShapes final : public MovingShapes {
 public:
  explicit MovingTriangleShapes(std::vector<MovingTriangles> meshes) : meshes_(std::move(meshes)) {}

  // Returns the bounds over the exposure, padded for the rounding of interpolated vertices.
  Boundsd bounds(int index) const override {
    const auto mesh =
        std::prev(std::upper_bound(meshes_.begin(), meshes_.end(), static_cast<std::size_t>(index),
                                   [](std::size_t i, const MovingTriangles& m) { return i < m.first; }));
    Boundsd box;
    for (const SharedVectors& positions : mesh->positions)
      for (const std::uint32_t vertex : mesh->triangles[static_cast<std::size_t>(index) - mesh->first])
        box.include((*positions)[vertex]);
    const Vec3d pad(4 * double{std::numeric_limits<float>::epsilon()} * box.magnitude());
    box.lo = box.lo - pad;
    box.hi = box.hi + pad;
    return box;
  }
  ShapeKernelPtr<float> kernel(float, int first) const override {
    return std::make_shared<Kernel<float>>(meshes_, first);
  }
  ShapeKernelPtr<double> kernel(double, int first) const override {
    return std::make_shared<Kernel<double>>(meshes_, first);
  }

 private:
  std::vector<MovingTriangles> meshes_;
};

}  // namespace

std::unique_ptr<MovingShapes> moving_triangles(std::vector<MovingTriangles> meshes) {
  return std::make_unique<MovingTriangleShapes>(std::move(meshes));
}

}  // namespace orrery
