#pragma once

#include <cmath>
#include <numbers>

#include "tests/bench/subject.h"

namespace orrery::bench {

// Builder of meshes without shared vertices.
struct MeshBuilder {
  Mesh mesh;

  unsigned add_vertex(const Vec3d& p) {
    mesh.positions.push_back(Vec3f(p));
    return static_cast<unsigned>(mesh.positions.size() - 1);
  }
  void add_triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const unsigned first = add_vertex(a);
    add_vertex(b);
    add_vertex(c);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  // Adds a quad by its corners in order.
  void add_quad(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
    add_triangle(a, b, c);
    add_triangle(a, c, d);
  }
  void add_box(const Vec3d& lo, const Vec3d& hi) {
    const auto corner = [&](int i) {
      return Vec3d(i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z);
    };
    for (const auto& [a, b, c, d] : {std::array{0, 1, 3, 2}, std::array{4, 5, 7, 6}, std::array{0, 1, 5, 4},
                                     std::array{2, 3, 7, 6}, std::array{0, 2, 6, 4}, std::array{1, 3, 7, 5}})
      add_quad(corner(a), corner(b), corner(c), corner(d));
  }
  // Adds a block on a floor, rotated by `angle` radians about its vertical axis. `half` is half the side of
  // the block.
  void add_block(const Vec3d& foot, double half, double height, double angle) {
    const auto at = [&](double x, double y, double z) {
      return foot + Vec3d(half * (x * std::cos(angle) - z * std::sin(angle)), y * height,
                          half * (x * std::sin(angle) + z * std::cos(angle)));
    };
    const std::array<std::array<double, 2>, 4> ring{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
    for (std::size_t i = 0; i < 4; ++i) {
      const auto& [x, z] = ring[i];
      const auto& [u, w] = ring[(i + 1) % 4];
      add_quad(at(x, 0, z), at(u, 0, w), at(u, 1, w), at(x, 1, z));
    }
    add_quad(at(-1, 1, -1), at(1, 1, -1), at(1, 1, 1), at(-1, 1, 1));
  }
  // Adds a square cell of a plate with a round hole about `center`. The cell is 2 `size` wide and 2 `half`
  // thick.
  void add_drilled_cell(const Vec3d& center, double size, double half, double radius, int segments) {
    const auto on_hole = [&](int i, double y) { return on_circle(center, radius, y, i, segments); };
    for (int i = 0; i < segments; ++i) {
      add_quad(on_hole(i, -half), on_hole(i, half), on_hole(i + 1, half), on_hole(i + 1, -half));
      for (const double y : {-half, half})
        add_triangle(on_hole(i, y), on_hole(i + 1, y), center + Vec3d(0, y, 0) + corner(size, i, segments));
    }
    for (const double y : {-half, half})  // fills the gaps between the triangle fans of the corners
      for (int quarter = 0; quarter < 4; ++quarter) {
        const int i = (quarter * segments + 3) / 4;
        add_triangle(on_hole(i, y), center + Vec3d(0, y, 0) + corner(size, i - 1, segments),
                     center + Vec3d(0, y, 0) + corner(size, i, segments));
      }
  }
  void add_shaft(const Vec3d& center, double radius, double from, double to, int segments) {
    for (int i = 0; i < segments; ++i) {
      const auto at = [&](int k, double y) { return on_circle(center, radius, y, k, segments); };
      add_quad(at(i, from), at(i, to), at(i + 1, to), at(i + 1, from));
      for (const double y : {from, to}) add_triangle(center + Vec3d(0, y, 0), at(i, y), at(i + 1, y));
    }
  }
  // Adds the four sides of a square plate, 2 `size` wide and 2 `half` thick.
  void add_plate_rim(double size, double half) {
    for (const double s : {-size, size}) {
      add_quad({s, -half, -size}, {s, half, -size}, {s, half, size}, {s, -half, size});
      add_quad({-size, -half, s}, {-size, half, s}, {size, half, s}, {size, -half, s});
    }
  }
  // Adds a vase, a surface of revolution of 4 segments^2 triangles.
  void add_pot(const Vec3d& foot, double radius, double height, int segments) {
    const auto at = [&](int row, int i) {
      const double s = static_cast<double>(row) / segments;
      return on_circle(foot, radius * (0.55 + 0.45 * std::sin(1 + 4.5 * s)), s * height, i, 2 * segments);
    };
    for (int row = 0; row < segments; ++row)
      for (int i = 0; i < 2 * segments; ++i)
        add_quad(at(row, i), at(row + 1, i), at(row + 1, i + 1), at(row, i + 1));
  }

 private:
  static Vec3d on_circle(const Vec3d& center, double radius, double y, int i, int segments) {
    const double angle = 2 * std::numbers::pi * (i % segments) / segments;
    return center + Vec3d(radius * std::cos(angle), y, radius * std::sin(angle));
  }
  // Returns the corner of the square nearest to the middle of segment i.
  static Vec3d corner(double size, int i, int segments) {
    const double angle = 2 * std::numbers::pi * (i + 0.5) / segments;
    return Vec3d(std::cos(angle) < 0 ? -size : size, 0, std::sin(angle) < 0 ? -size : size);
  }
};

}  // namespace orrery::bench
