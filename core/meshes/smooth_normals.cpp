#include <algorithm>
#include <cmath>

#include "core/base/task_scope.h"
#include "core/math/angles.h"
#include "core/math/face_normal.h"
#include "core/meshes/repair.h"
#include "core/meshes/vertex_list.h"

namespace orrery {
namespace {

// Returns the angle between unit vectors in radians, or 0 between two zero vectors: 2 atan(|u - v| / |u + v|)
// (Kahan), accurate to a few ulps for all angles. Halves the arctangent three times before the series. Uses
// only IEEE operations, so that every machine returns the same bits.
double angle_between(const Vec3d& u, const Vec3d& v) {
  const double opposite = length(u - v), adjacent = length(u + v);
  if (opposite == 0) return 0;
  double tangent = opposite / (adjacent + std::sqrt(opposite * opposite + adjacent * adjacent));
  for (int halving = 0; halving < 2; ++halving) tangent /= 1 + std::sqrt(1 + tangent * tangent);
  const double square = tangent * tangent;  // at most tan(pi/16)^2 < 0.04
  double series = 0;
  for (int k = 12; k >= 0; --k) series = 1.0 / (2 * k + 1) - square * series;
  return 16 * tangent * series;
}

// Corners by position. Corner k of triangle t has number 3 t + k. The corners at position p are
// list[first[p]] to list[first[p + 1] - 1], in ascending order.
struct Corners {
  std::vector<std::uint32_t> position;  // position number of each corner
  std::vector<std::uint32_t> first, list;

  Corners(const TriangleMesh& mesh, const PositionIndices& places) {
    const std::size_t count = places.empty() ? 0 : *std::max_element(places.begin(), places.end()) + 1;
    position.reserve(3 * mesh.triangles.size());
    first.assign(count + 1, 0);
    for (const auto& triangle : mesh.triangles)
      for (const std::uint32_t vertex : triangle) {
        position.push_back(places[vertex]);
        ++first[position.back() + 1];
      }
    for (std::size_t p = 1; p < first.size(); ++p) first[p] += first[p - 1];
    list.resize(position.size());
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (std::uint32_t corner = 0; corner < position.size(); ++corner)
      list[next[position[corner]]++] = corner;
  }
};

struct Facets {
  std::vector<Vec3d> normals;   // per triangle; 0 for triangles without area
  std::vector<Vec3d> weighted;  // per corner: the normal times the angle at the corner, in radians

  explicit Facets(const TriangleMesh& mesh) {
    normals.reserve(mesh.triangles.size());
    weighted.reserve(3 * mesh.triangles.size());
    for (const auto& t : mesh.triangles) {
      checkpoint();
      const Vec3d &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
      const Vec3d normal = face_normal(a, b, c);
      const Vec3d ab = safe_normalize(b - a), bc = safe_normalize(c - b), ca = safe_normalize(a - c);
      normals.push_back(normal);
      weighted.push_back(normal * angle_between(ab, -ca));
      weighted.push_back(normal * angle_between(bc, -ab));
      weighted.push_back(normal * angle_between(ca, -bc));
    }
  }
};

// Returns the normal of a corner. If the triangle of the corner has no area, averages over all triangles at
// the position.
Vec3d corner_normal(std::uint32_t corner, const Corners& corners, const Facets& facets, double min_cosine) {
  const Vec3d own = facets.normals[corner / 3];
  const bool flat = own == Vec3d();
  const std::uint32_t position = corners.position[corner];
  Vec3d sum;
  for (std::uint32_t i = corners.first[position]; i < corners.first[position + 1]; ++i) {
    checkpoint(i);
    const std::uint32_t other = corners.list[i];
    if (flat || other == corner || dot(own, facets.normals[other / 3]) > min_cosine)
      sum = sum + facets.weighted[other];
  }
  for (const Vec3d& candidate : {sum, own})
    if (const Vec3d unit = safe_normalize(candidate); unit != Vec3d()) return unit;
  return {0, 0, 1};  // reached only for triangles without area, which no ray hits
}

// Returns one normal per position, or 0 for positions whose corners may have different normals. Around the
// others, every facet is within half of the crease angle of the first, so every corner averages over all.
std::vector<Vec3d> shared_normals(const Corners& corners, const Facets& facets, double crease_degrees) {
  constexpr double kMargin = 1e-9;  // far above the rounding errors of cosines
  const double min_cosine = sine_cosine_degrees(crease_degrees / 2).cosine + kMargin;
  std::vector<Vec3d> shared(corners.first.size() - 1);
  for (std::size_t position = 0; position < shared.size(); ++position) {
    checkpoint();
    const std::uint32_t begin = corners.first[position], end = corners.first[position + 1];
    Vec3d sum;
    std::uint32_t i = begin;
    for (; i < end; ++i) {
      checkpoint(i);
      const std::uint32_t corner = corners.list[i];
      if (!(dot(facets.normals[corners.list[begin] / 3], facets.normals[corner / 3]) > min_cosine)) break;
      sum = sum + facets.weighted[corner];
    }
    if (i == end) shared[position] = safe_normalize(sum);
  }
  return shared;
}

}  // namespace

PositionIndices position_indices_of(const std::vector<Vec3d>& positions) {
  PositionIndices places;
  places.reserve(positions.size());
  VertexList distinct(false, false);
  for (const Vec3d& position : positions) places.push_back(distinct.add({position, {}, {}}));
  return places;
}

void split_position_indices(PositionIndices& places, const std::vector<Vec3d>& positions) {
  VertexList apart(true, false);  // stores the old number in the normal
  for (std::size_t v = 0; v < places.size(); ++v)
    places[v] = apart.add({positions[v], Vec3d(places[v], 0, 0), {}});
}

std::uint64_t count_pairs(const TriangleMesh& mesh, const PositionIndices& places) {
  std::vector<std::uint64_t> corners(places.size(), 0);  // by position number
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle) ++corners[places[vertex]];
  std::uint64_t pairs = 0;
  for (const std::uint64_t count : corners) pairs += count * count;
  return pairs;
}

void smooth_normals(TriangleMesh& mesh, double crease_degrees, const PositionIndices& places) {
  const Corners corners(mesh, places);
  const Facets facets(mesh);
  const double min_cosine = sine_cosine_degrees(crease_degrees).cosine;
  const std::vector<Vec3d> shared = shared_normals(corners, facets, crease_degrees);
  VertexList vertices(true, !mesh.uvs.empty(), !mesh.colors.empty());
  std::vector<std::array<std::uint32_t, 3>> triangles = mesh.triangles;
  constexpr std::uint32_t kNone = ~0u;
  std::vector<std::uint32_t> last(mesh.positions.size(), kNone);  // new number of a vertex at its last corner
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t old = triangles[t][k];
      const Vec3d& same = shared[places[old]];
      const Vec3d normal = same == Vec3d() ? corner_normal(3 * t + k, corners, facets, min_cosine) : same;
      if (last[old] == kNone || vertices.normal(last[old]) != normal) {
        Vertex vertex = vertex_of(mesh, old);
        vertex.normal = normal;
        last[old] = vertices.add(vertex);
      }
      triangles[t][k] = last[old];
    }
  mesh = vertices.take();
  mesh.triangles = std::move(triangles);
}

}  // namespace orrery
