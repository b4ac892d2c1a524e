#include "tests/bench/subject.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

namespace orrery::bench {
namespace {

constexpr int kSide = 768;  // pixels

}  // namespace

Mesh bumpy_sphere(int triangles) {
  const int side = std::max(3, static_cast<int>(std::sqrt(triangles / 2.0)));
  Mesh mesh;
  for (int row = 0; row <= side; ++row) {
    for (int column = 0; column < side; ++column) {
      const double polar = std::numbers::pi * row / side, around = 2 * std::numbers::pi * column / side;
      const double bumps = 0.1 * std::sin(5 * polar) * std::cos(4 * around) +
                           0.03 * std::sin(31 * polar) * std::cos(24 * around) +
                           0.01 * std::cos(83 * polar + 40 * around);
      const double radius = 1 + bumps * std::sin(polar);
      mesh.positions.push_back(
          Vec3f(Vec3d(radius * std::sin(polar) * std::cos(around), radius * std::cos(polar),
                      radius * std::sin(polar) * std::sin(around))));
    }
  }
  const auto at = [&](int row, int column) { return static_cast<unsigned>(row * side + column % side); };
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      if (row > 0) mesh.triangles.push_back({at(row, column), at(row, column + 1), at(row + 1, column)});
      if (row + 1 < side)
        mesh.triangles.push_back({at(row, column + 1), at(row + 1, column + 1), at(row + 1, column)});
    }
  }
  return mesh;
}

Rays primary_rays() {
  const Vec3f eye(0.7f, 0.9f, 2.6f);
  const Vec3f back = normalize(eye), right = normalize(cross(Vec3f(0, 1, 0), back)), up = cross(back, right);
  Rays rays;
  for (int block = 0; block < kSide * kSide / 16; ++block) {
    for (int i = 0; i < 16; ++i) {
      const int x = block % (kSide / 4) * 4 + i % 4, y = block / (kSide / 4) * 4 + i / 4;
      const float u = (static_cast<float>(x) + 0.5f) / kSide - 0.5f,
                  v = (static_cast<float>(y) + 0.5f) / kSide - 0.5f;
      rays.push_back({eye, normalize(right * u + up * v - back)});
    }
  }
  return rays;
}

Rays bounce_rays(const Mesh& mesh, const Rays& primary, const std::vector<int>& hit_triangle,
                 const std::vector<float>& t) {
  std::mt19937 random(1);
  std::normal_distribution<float> normal_number;
  Rays rays;
  for (std::size_t n = 0; n < primary.size(); ++n) {
    if (hit_triangle[n] == kNoPrimitive) continue;
    const auto [i, j, k] = mesh.triangles[static_cast<std::size_t>(hit_triangle[n])];
    const Vec3f a = mesh.positions[i], b = mesh.positions[j], c = mesh.positions[k];
    Vec3f normal = normalize(cross(b - a, c - a));
    if (dot(normal, primary[n].direction) > 0) normal = -normal;
    const Vec3f ball = normalize(Vec3f(normal_number(random), normal_number(random), normal_number(random)));
    const Vec3f direction = normalize(normal + ball * 0.999f);
    rays.push_back({primary[n].at(t[n]) + normal * 1e-4f, direction});
  }
  return rays;
}

}  // namespace orrery::bench
