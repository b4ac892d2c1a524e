#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/params/params.h"
#include "core/shapes/primitive_set.h"
#include "core/shapes/triangle_hit.h"

namespace orrery {
namespace {

constexpr std::size_t kMaxTriangles = 10'000'000;
constexpr std::size_t kMaxVertices = 10'000'000;

// One triangle of a mesh, with the normals to interpolate at its vertices.
template <class N>
struct MeshTriangle {
  Corners<N> corners, normals;
  Vec3<N> normal;  // of the flat triangle
  N magnitude;     // largest absolute coordinate of the mesh

  static constexpr ShapeTraits kTraits = {.convex = false, .closed = false};

  static void read(Params& p, std::vector<MeshTriangle<double>>& out) {
    const std::vector<Vec3d> positions = p.points("positions", "Vertices, in metres.", {3, kMaxVertices});
    const auto triples =
        p.index_triples("indices", "Vertices of each triangle, anticlockwise from the front.",
                        {1, kMaxTriangles}, static_cast<std::int64_t>(positions.size()));
    const std::vector<Vec3d> normals =
        p.directions("normals", "Direction to shade with at each vertex; left out, triangles are flat.",
                     {0, kMaxVertices});
    if (!normals.empty() && normals.size() != positions.size())
      return p.fail("normals", "expected as many as positions (" + std::to_string(positions.size()) +
                                   "), got " + std::to_string(normals.size()));
    Boundsd box;
    for (const Vec3d& v : positions) box.include(v);
    for (const auto& triple : triples) {
      std::array<std::size_t, 3> i;
      for (std::size_t k = 0; k < 3; ++k) i[k] = static_cast<std::size_t>(triple[k]);
      if (std::max({i[0], i[1], i[2]}) >= positions.size()) return;  // reported already
      const Vec3d a = positions[i[0]], b = positions[i[1]], c = positions[i[2]];
      const Vec3d flat = safe_normalize(cross(b - a, c - a));
      if (flat == Vec3d()) continue;  // no area: no ray can meet it
      const auto at = [&](std::size_t k) { return normals.empty() ? flat : normals[i[k]]; };
      out.push_back({{a, b, c}, {at(0), at(1), at(2)}, flat, box.magnitude()});
    }
  }

  Boundsd bounds() const { return corners.bounds(); }
  std::vector<HullTriangle> hull() const { return corners.hull(); }

  using Core = Corners<N>;
  const Core& core() const { return corners; }
  N distance(const Ray<N>& ray) const { return corners.distance(ray); }

  // The interpolated normal falls back to the flat one where the three cancel.
  Surface<N> surface(const Ray<N>& ray, const N&) const {
    const Vec3<N> weights = corners.weights(ray);
    const Vec3<N> sum = normals.mix(weights);
    const N size = length(sum);
    const auto usable = size > N(ScalarOf<N>(0.001));  // unit normals: below it they point opposite ways
    const auto choose = [&](const N& x, const N& flat) { return select(usable, N(x / size), flat); };
    return {corners.mix(weights),
            normal,
            {choose(sum.x, normal.x), choose(sum.y, normal.y), choose(sum.z, normal.z)},
            magnitude};
  }
};

}  // namespace

ShapeType mesh_type() {
  return {"mesh", "Triangles over shared vertices, watertight along shared edges.",
          make_shape_set<MeshTriangle>};
}

}  // namespace orrery
