#include "tests/bench/subject.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <numbers>
#include <random>

#include "core/base/error.h"
#include "core/meshes/mesh_file.h"
#include "tests/bench/mesh_builder.h"

namespace orrery::bench {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr float kRoomReach = 3;  // half the side of the cube
const Vec3f kUnderCeiling(0, 0.55f, 0);

// Returns a closed sphere of similar triangles, with bumps of several sizes. `jitter` is the maximum
// displacement of vertices along the surface, relative to their distance.
Mesh bumpy_sphere(int triangles, double jitter) {
  const int side = std::max(3, static_cast<int>(std::sqrt(triangles / 2.0)));
  std::mt19937 random(2);
  std::uniform_real_distribution<double> stray(-jitter, jitter);
  Mesh mesh;
  for (int row = 0; row <= side; ++row) {
    for (int column = 0; column < side; ++column) {
      const bool pole = row == 0 || row == side;
      const double polar = kPi * (row + (pole ? 0 : stray(random))) / side,
                   around = 2 * kPi * (column + stray(random)) / side;
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

Subject ball(int triangles) { return {bumpy_sphere(triangles, 0)}; }

// Laser scan: a folded surface of triangles of all shapes.
Subject scan(int triangles) {
  Mesh mesh = bumpy_sphere(triangles, 0.45);
  for (Vec3f& p : mesh.positions) {
    const float twist = 2.5f * p.y, fold = 1 + 0.12f * std::sin(9 * p.x + 5 * p.y);
    p = Vec3f(p.x * std::cos(twist) - p.z * std::sin(twist), p.y * 1.2f,
              (p.x * std::sin(twist) + p.z * std::cos(twist)) * 0.7f) *
        fold;
  }
  return {std::move(mesh)};
}

// CAD export: a plate with holes and shafts. It has large flat faces, and round faces of triangles whose
// width is 1/100 of their length.
Subject cad(int triangles) {
  constexpr int kHoles = 5;  // per side
  // At most 8 triangles per segment and hole: two fans and a wall of the hole, and a wall and two caps of a
  // shaft in every second hole.
  const int segments = std::max(8, static_cast<int>(triangles / (8.0 * kHoles * kHoles)));
  MeshBuilder out;
  for (int row = 0; row < kHoles; ++row)
    for (int column = 0; column < kHoles; ++column) {
      const double size = 1.0 / kHoles;
      const Vec3d center(size * (2 * column + 1) - 1, 0, size * (2 * row + 1) - 1);
      out.add_drilled_cell(center, size, 0.1, 0.55 * size, segments);
      if ((row + column) % 2 == 0) out.add_shaft(center, 0.35 * size, -0.4, 0.6, segments);
    }
  out.add_plate_rim(1, 0.1);
  return {std::move(out.mesh)};
}

// Foliage: leaves in crowns, with much empty space between them.
Subject foliage(int triangles) {
  constexpr int kCrowns = 14;
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto direction = [&] { return normalize(Vec3d(normal(random), normal(random), normal(random))); };
  const double leaf = 2.5 / std::sqrt(static_cast<double>(triangles));
  std::vector<Vec3d> crowns;
  for (int i = 0; i < kCrowns; ++i) crowns.push_back(direction() * 0.7);
  MeshBuilder out;
  for (int i = 0; i < triangles / 2; ++i) {
    const Vec3d at = crowns[static_cast<std::size_t>(i % kCrowns)] +
                     Vec3d(normal(random), normal(random), normal(random)) * 0.11;
    const Vec3d along = direction() * leaf, across = normalize(cross(along, direction())) * (0.5 * leaf);
    out.add_quad(at - along, at - across, at + along, at + across);
  }
  return {std::move(out.mesh)};
}

// Hair: ribbons whose width is 1/400 of their length.
Subject hair(int triangles) {
  constexpr int kPieces = 8;
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  const auto direction = [&] { return normalize(Vec3d(normal(random), normal(random), normal(random))); };
  MeshBuilder out;
  for (int strand = 0; strand < triangles / (2 * kPieces); ++strand) {
    const Vec3d root = direction(), curl = direction() * 0.06;
    Vec3d at = root * 0.45, along = root * 0.06;
    const Vec3d across = normalize(cross(root, direction())) * 0.0006;
    for (int piece = 0; piece < kPieces; ++piece) {
      const Vec3d next = at + along;
      out.add_quad(at - across, at + across, next + across, next - across);
      at = next;
      along = normalize(along + curl * 0.3 + Vec3d(0, -0.006, 0)) * 0.06;
    }
  }
  return {std::move(out.mesh)};
}

// Cornell box: five walls and two blocks, whatever the number of triangles.
Subject cornell(int) {
  MeshBuilder out;
  const Vec3d a(-0.57, -0.57, -0.57), b(0.57, 0.57, 0.57);
  out.add_quad({a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, b.y, a.z}, {a.x, b.y, a.z});
  out.add_quad({a.x, a.y, a.z}, {a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, a.y, a.z});
  out.add_quad({a.x, b.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z});
  out.add_quad({a.x, a.y, a.z}, {a.x, b.y, a.z}, {a.x, b.y, b.z}, {a.x, a.y, b.z});
  out.add_quad({b.x, a.y, a.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {b.x, b.y, a.z});
  out.add_block({-0.2, -0.57, -0.2}, 0.17, 0.68, 0.3);
  out.add_block({0.2, -0.57, 0.2}, 0.17, 0.34, -0.3);
  return {std::move(out.mesh), Vec3f(0, 0, 1.9f), kUnderCeiling, 0.25f};
}

// Room seen from inside: large walls, a table with pots, and shelves of finely tessellated pots.
Subject interior(int triangles) {
  MeshBuilder out;
  out.add_box({-0.57, -0.57, -0.57}, {0.57, 0.57, 0.57});
  out.add_box({-0.3, -0.3, -0.25}, {0.2, -0.27, 0.1});
  for (const double x : {-0.28, 0.17})
    for (const double z : {-0.23, 0.07}) out.add_box({x, -0.57, z}, {x + 0.02, -0.3, z + 0.02});
  constexpr int kShelves = 4, kPots = 6;
  const int segments = std::max(4, static_cast<int>(std::sqrt(triangles / (4.0 * (kShelves * kPots + 3)))));
  for (int shelf = 0; shelf < kShelves; ++shelf) {
    const double y = -0.4 + 0.22 * shelf;
    out.add_box({-0.5, y, -0.55}, {0.5, y + 0.01, -0.45});
    for (int pot = 0; pot < kPots; ++pot)
      out.add_pot(Vec3d(-0.42 + 0.165 * pot, y + 0.011, -0.5), 0.035, 0.09, segments);
  }
  for (int pot = 0; pot < 3; ++pot)
    out.add_pot(Vec3d(-0.2 + 0.15 * pot, -0.269, -0.05), 0.05, 0.12, segments);
  return {std::move(out.mesh), Vec3f(0.3f, 0.1f, 0.48f), kUnderCeiling, 0.25f};
}

struct NamedSubject {
  const char* name;
  Subject (*make)(int triangles);
};
constexpr NamedSubject kSubjects[] = {{"ball", ball},        {"scan", scan}, {"cad", cad},
                                      {"foliage", foliage},  {"hair", hair}, {"cornell", cornell},
                                      {"interior", interior}};

Mesh mesh_of_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error("cannot read " + path + ": neither a subject nor a file");
  const TriangleMesh read = read_mesh(std::string(std::istreambuf_iterator<char>(in), {}));
  Mesh mesh;
  for (const Vec3d& p : read.positions) mesh.positions.push_back(Vec3f(p));
  for (const auto& t : read.triangles) mesh.triangles.push_back({t[0], t[1], t[2]});
  return mesh;
}

void fit_in_unit_sphere(Mesh& mesh) {
  Vec3f lo(1e30f, 1e30f, 1e30f), hi = -lo;
  for (const Vec3f& p : mesh.positions) {
    lo = Vec3f(std::min(lo.x, p.x), std::min(lo.y, p.y), std::min(lo.z, p.z));
    hi = Vec3f(std::max(hi.x, p.x), std::max(hi.y, p.y), std::max(hi.z, p.z));
  }
  const Vec3f center = (lo + hi) * 0.5f;
  float radius = 0;
  for (const Vec3f& p : mesh.positions) radius = std::max(radius, length(p - center));
  for (Vec3f& p : mesh.positions) p = (p - center) * (1 / radius);
}

}  // namespace

std::vector<std::string> subject_names() {
  std::vector<std::string> names;
  for (const NamedSubject& subject : kSubjects) names.emplace_back(subject.name);
  return names;
}

Subject subject_of(const std::string& name, int triangles) {
  for (const NamedSubject& subject : kSubjects) {
    if (name != subject.name) continue;
    Subject made = subject.make(triangles);
    if (name != "ball" && name != "interior" && name != "cornell") fit_in_unit_sphere(made.mesh);
    return made;
  }
  Subject read{mesh_of_file(name)};
  fit_in_unit_sphere(read.mesh);
  return read;
}

void put_in_room(Mesh& mesh) {
  MeshBuilder walls;
  walls.add_box(Vec3d(-1, -1, -1) * kRoomReach, Vec3d(1, 1, 1) * kRoomReach);
  const auto first = static_cast<unsigned>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), walls.mesh.positions.begin(), walls.mesh.positions.end());
  for (const auto& [a, b, c] : walls.mesh.triangles)
    mesh.triangles.push_back({a + first, b + first, c + first});
}

}  // namespace orrery::bench
