#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <span>
#include <vector>

#include "core/math/angles.h"
#include "core/math/vec3.h"

namespace orrery {

// Camera in the coordinates of the shapes that are tessellated, in metres.
struct TessellationView {
  Vec3d eye, forward;  // `forward` is a unit vector
  bool parallel = false;
  double pixel_width = 0, pixel_spread = 0;  // see PixelFootprint
  double max_error = 0;                      // largest distance from the surface, pixels
  double reach =
      0;  // parallel: radius of the view in metres; otherwise the smallest cosine of a ray to `forward`

  // Returns the width of a pixel in metres on visible points that are `distance` metres or more from the eye.
  double pixel_at(double distance) const {
    return parallel ? pixel_width : pixel_spread * reach * std::max(distance, 0.0);
  }
  // Returns the distance along an unbounded surface after which the rest of it covers less than `max_error`
  // pixels. `offset` is the distance of the eye from the surface, in metres. REQUIRES: !parallel.
  double vanishing_distance(double offset) const { return offset / (max_error * pixel_spread * reach); }
};

// Triangles that approximate the surfaces of a scene.
struct Tessellation {
  struct Vertex {
    Vec3d position;
    Vec3d normal;  // outward unit normal, or 0: that of the triangle
  };
  struct Triangle {
    std::array<std::uint32_t, 3> vertices;  // anticlockwise as seen from outside
    std::int32_t primitive;
  };
  // Triangles that are used where a set of shapes stores them. They follow `before` of `triangles`.
  struct Mesh {
    std::span<const Vec3d> positions, normals;  // one normal for each position, or none
    std::span<const std::array<std::uint32_t, 3>> triangles;
    std::int32_t first_primitive;
    std::size_t before;
  };
  std::vector<Vertex> vertices;
  std::vector<Triangle> triangles;
  std::vector<Mesh> meshes;
  bool may_refer = false;  // whether sets may add to `meshes`, because they outlive this object
  double error = 0;        // largest distance of a triangle from its surface, pixels

  std::uint32_t add(const Vec3d& position, const Vec3d& normal = {}) {
    vertices.push_back({position, normal});
    return static_cast<std::uint32_t>(vertices.size() - 1);
  }
  void add(int primitive, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    triangles.push_back({{a, b, c}, primitive});
  }
  void add_quad(int primitive, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    add(primitive, a, b, c);
    add(primitive, a, c, d);
  }

  // Adds closed rings of `sectors` vertices each, and the quads between adjacent rings. at(ring, turn)
  // returns the vertex of a ring at an angle. As seen from outside, ring 0 is innermost and the angle
  // increases anticlockwise. Rings may be single points.
  template <class At>
  void add_rings(int primitive, int rings, int sectors, const At& at) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    const auto wide = static_cast<std::uint32_t>(sectors);
    for (int ring = 0; ring < rings; ++ring)
      for (const SineCosine& turn : circle(sectors)) vertices.push_back(at(ring, turn));
    for (std::uint32_t inner = first; inner < first + wide * static_cast<std::uint32_t>(rings - 1);
         inner += wide)
      for (std::uint32_t s = 0; s < wide; ++s) {
        const std::uint32_t next = (s + 1) % wide;
        add_quad(primitive, inner + s, inner + wide + s, inner + wide + next, inner + next);
      }
  }

  // Returns the number of sides of a regular polygon, 6 to kMaxSides, whose sides are within
  // share * view.max_error pixels of `pixel` metres of its circumscribed circle. Records the error, with the
  // rest of it left to other polygons. A polygon of n sides is off by 2 r sin^2(pi / 2n), which is less than
  // r (pi / n)^2 / 2.
  int sides(const TessellationView& view, double radius, double pixel, double share = 1) {
    const double least = std::sqrt(radius / (2 * share * view.max_error * pixel)) * std::numbers::pi;
    const int count = std::max(6, static_cast<int>(std::ceil(std::min(least, double{kMaxSides}))));
    const double angle = std::numbers::pi / count;
    error = std::max(error, radius * angle * angle / (2 * share * pixel));
    return count;
  }

  // Returns the number of triangles, those of meshes included.
  std::size_t size() const {
    std::size_t sum = triangles.size();
    for (const Mesh& mesh : meshes) sum += mesh.triangles.size();
    return sum;
  }

  static constexpr int kMaxSides = 1024;

 private:
  // Returns the sines and cosines of `count` angles that divide a turn.
  const std::vector<SineCosine>& circle(int count) {
    std::vector<SineCosine>& turns = circles_[count];
    for (int i = static_cast<int>(turns.size()); i < count; ++i)
      turns.push_back(sine_cosine_degrees(360.0 * i / count));
    return turns;
  }

  std::map<int, std::vector<SineCosine>> circles_;  // by the number of sides
};

}  // namespace orrery
