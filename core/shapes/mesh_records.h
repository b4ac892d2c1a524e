#pragma once

#include <algorithm>

#include "core/base/task_scope.h"
#include "core/math/face_normal.h"
#include "core/meshes/mesh_file.h"
#include "core/shapes/primitive_set.h"
#include "core/shapes/triangle_hit.h"

namespace orrery {

// Triangle of a mesh, with the normals of its vertices.
template <class N>
struct MeshTriangle {
  Corners<N> corners, normals;
  Vec3<N> normal;  // geometric normal
  N magnitude;     // largest absolute coordinate of the mesh

  std::vector<HullTriangle> hull() const { return corners.hull(); }

  using Core = Corners<N>;
  const Core& core() const { return corners; }
  N distance(const Ray<N>& ray) const { return corners.distance(ray); }

  Surface<N> surface(const Ray<N>& ray, const N&) const {
    const Vec3<N> weights = corners.weights(ray);
    return {corners.mix(weights), normal, shading_normal(weights), magnitude};
  }

  SmoothSurface<N> smooth(const Ray<N>& ray) const {
    const N zero(ScalarOf<N>(0)), one(ScalarOf<N>(1));
    const N side = select(dot(normal, ray.direction) > zero, N(-one), one);
    const Vec3<N> weights = corners.weights(ray), position = corners.mix(weights);
    const auto above = [&](const Vec3<N>& corner, const Vec3<N>& n) {
      return n * (side * max_first(zero, N(-(side * dot(position - corner, n)))));
    };
    return {shading_normal(weights) * side, above(corners.a, normals.a) * weights.x +
                                                above(corners.b, normals.b) * weights.y +
                                                above(corners.c, normals.c) * weights.z};
  }

 private:
  // Interpolates the vertex normals, or uses the geometric normal if the vertex normals cancel.
  Vec3<N> shading_normal(const Vec3<N>& weights) const {
    const Vec3<N> sum = normals.mix(weights);
    const N size = length(sum);
    const auto usable = size > N(ScalarOf<N>(0.001));  // otherwise the vertex normals nearly cancel
    const auto choose = [&](const N& x, const N& flat) { return select(usable, N(x / size), flat); };
    return {choose(sum.x, normal.x), choose(sum.y, normal.y), choose(sum.z, normal.z)};
  }
};

// Mapping from hit points on a mesh triangle to parameters and texture coordinates.
template <class N>
struct MeshMapping {
  Corners<N> corners;
  Vec3<N> s, t;  // texture coordinates of the vertices

  // u and v are the barycentric weights of the second and third vertex. The tangent points toward increasing
  // s, or along the first edge if the texture coordinates are degenerate.
  SurfacePoint<N> parameters(const Ray<N>& ray, const Vec3<N>&) const {
    using std::abs;
    using T = ScalarOf<N>;
    const Vec3<N> weights = corners.weights(ray);
    const Vec3<N> ab = corners.b - corners.a, ac = corners.c - corners.a;
    const N s1 = s.y - s.x, t1 = t.y - t.x, s2 = s.z - s.x, t2 = t.z - t.x;
    const N determinant = s1 * t2 - s2 * t1, zero(T(0));
    const Vec3<N> along = (ab * t2 - ac * t1) * select(determinant < zero, N(T(-1)), N(T(1)));
    const auto usable = dot(along, along) > zero && abs(determinant) > zero;
    return {weights.y, weights.z, dot(s, weights), dot(t, weights), normalize(select(usable, along, ab))};
  }
};

// Vertex colours of a mesh triangle.
template <class N>
struct MeshColors {
  Corners<N> corners, colors;

  Vec3<N> color(const Ray<N>& ray) const { return colors.mix(corners.weights(ray)); }
};

// Indexed triangles of several meshes.
template <class T>
struct MeshTable {
  struct Part {
    std::size_t first;  // index of the first triangle of the mesh
    std::size_t first_vertex, first_normal, first_uv, first_color;
    bool smooth, mapped, colored;  // whether there is one normal, one uv and one colour per vertex
    T magnitude;                   // largest absolute coordinate of the mesh
  };
  std::vector<Vec3<T>> positions, normals, colors;
  std::vector<std::array<T, 2>> uvs;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Part> parts;  // ascending by `first`

  Corners<T> corners(std::size_t i) const {
    const auto& [a, b, c] = triangles[i];
    return {positions[a], positions[b], positions[c]};
  }
  const Part& part_of(std::size_t i) const {
    return *std::prev(std::upper_bound(parts.begin(), parts.end(), i,
                                       [](std::size_t n, const Part& part) { return n < part.first; }));
  }
};

// MeshTriangles in the render's precision, assembled on access.
template <class T>
class MeshRecords {
 public:
  explicit MeshRecords(const MeshTable<double>& table) {
    for (const auto& v : table.positions) table_.positions.push_back(Vec3<T>(v));
    for (const auto& v : table.normals) table_.normals.push_back(Vec3<T>(v));
    for (const auto& v : table.colors) table_.colors.push_back(Vec3<T>(v));
    for (const auto& [u, v] : table.uvs) table_.uvs.push_back({static_cast<T>(u), static_cast<T>(v)});
    table_.triangles = table.triangles;
    for (const auto& part : table.parts)
      table_.parts.push_back({part.first, part.first_vertex, part.first_normal, part.first_uv,
                              part.first_color, part.smooth, part.mapped, part.colored,
                              static_cast<T>(part.magnitude)});
    flat_.reserve(table.triangles.size());
    for (std::size_t i = 0; i < table.triangles.size(); ++i) {
      checkpoint(i);
      const Corners<double> at = table.corners(i);
      flat_.push_back(Vec3<T>(face_normal(at.a, at.b, at.c)));
    }
  }

  std::size_t size() const { return flat_.size(); }
  // Returns the corners of triangle i, or its first corner three times if it has no area. Rounding therefore
  // cannot produce a hit with a degenerate triangle.
  Corners<T> core(std::size_t i) const {
    const Corners<T> corners = table_.corners(i);
    return flat_[i] == Vec3<T>() ? Corners<T>{corners.a, corners.a, corners.a} : corners;
  }
  MeshTriangle<T> operator[](std::size_t i) const {
    const auto& part = table_.part_of(i);
    const Vec3<T>& flat = flat_[i];
    const auto normal = [&](std::uint32_t vertex) {
      return part.smooth ? table_.normals[part.first_normal + vertex - part.first_vertex] : flat;
    };
    const auto& [a, b, c] = table_.triangles[i];
    return {core(i), {normal(a), normal(b), normal(c)}, flat, part.magnitude};
  }

  template <class N>
  using Mapping = MeshMapping<N>;
  // Mappings of the triangles. In meshes without texture coordinates, s and t are the weights of the second
  // and third vertex.
  struct Mappings {
    const MeshRecords& records;
    MeshMapping<T> operator[](std::size_t i) const {
      const auto& table = records.table_;
      const auto& part = table.part_of(i);
      if (!part.mapped) return {table.corners(i), {T(0), T(1), T(0)}, {T(0), T(0), T(1)}};
      const auto uv = [&](std::uint32_t vertex) {
        return table.uvs[part.first_uv + vertex - part.first_vertex];
      };
      const auto& [a, b, c] = table.triangles[i];
      return {table.corners(i), {uv(a)[0], uv(b)[0], uv(c)[0]}, {uv(a)[1], uv(b)[1], uv(c)[1]}};
    }
  };
  Mappings mappings() const { return {*this}; }

  template <class N>
  using Colors = MeshColors<N>;
  // Vertex colours of the triangles, which are 1 in meshes without colours.
  struct ColorList {
    const MeshRecords& records;
    MeshColors<T> operator[](std::size_t i) const {
      const auto& table = records.table_;
      const auto& part = table.part_of(i);
      const auto color = [&](std::uint32_t vertex) {
        return part.colored ? table.colors[part.first_color + vertex - part.first_vertex] : Vec3<T>(T(1));
      };
      const auto& [a, b, c] = table.triangles[i];
      return {table.corners(i), {color(a), color(b), color(c)}};
    }
  };
  ColorList colors() const { return {*this}; }
  bool has_colors() const { return !table_.colors.empty(); }

 private:
  MeshTable<T> table_;
  std::vector<Vec3<T>> flat_;
};

}  // namespace orrery
