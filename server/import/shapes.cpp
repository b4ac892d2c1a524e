#include "server/import/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/base/task_scope.h"

namespace orrery {
namespace {

// Control point of a rational curve.
struct CurvePoint {
  double x, y, weight;
};
using CurveArc = std::vector<CurvePoint>;

// Returns the arc of a circle from one angle to another in radians, as conic pieces of at most a quarter:
// three control points each, of which the middle one has the cosine of half the angle as its weight (Piegl
// and Tiller, The NURBS Book, 1997, section 7.3).
std::vector<CurveArc> arcs_of(double radius, double from, double to) {
  const int count = std::max(1, static_cast<int>(std::ceil((to - from) / (std::numbers::pi / 2) - 1e-9)));
  const double step = (to - from) / count, weight = std::cos(step / 2);
  std::vector<CurveArc> arcs;
  for (int i = 0; i < count; ++i) {
    const double start = from + i * step, middle = start + step / 2, end = start + step;
    const auto at = [&](double angle, double r, double w) {
      return CurvePoint{r * std::cos(angle), r * std::sin(angle), w};
    };
    arcs.push_back({at(start, radius, 1), at(middle, radius / weight, weight), at(end, radius, 1)});
  }
  return arcs;
}

// Adds the surface that profiles, of x (distance from the axis) and y (height), sweep around the z axis.
void add_swept(SceneWriter& scene, const Affined& map, const std::vector<CurveArc>& profiles,
               const Sweep& sweep, const std::string& material) {
  SceneJson points = SceneJson::array(), weights = SceneJson::array();
  for (const CurveArc& around : arcs_of(1, 0, sweep.degrees * std::numbers::pi / 180))
    for (const CurveArc& profile : profiles)
      for (const CurvePoint& along : profile)
        for (const CurvePoint& turn : around) {
          points.push_back(scene.point(map.point({along.x * turn.x, along.x * turn.y, along.y})));
          weights.push_back(along.weight * turn.weight);
        }
  scene.add_object({{"type", "patch"},
                    {"material", material},
                    {"degree_u", 2},
                    {"degree_v", profiles.front().size() - 1},
                    {"points", std::move(points)},
                    {"weights", std::move(weights)}});
}

bool is_at_right_angles(const Vec3d& a, const Vec3d& b) {
  return std::abs(dot(safe_normalize(a), safe_normalize(b))) <= 1e-9;
}

// Whether a vector is along one coordinate axis.
bool is_along_axis(const Vec3d& v) {
  const double largest = max_component(abs(v));
  const auto vanishes = [&](double x) { return std::abs(x) <= 1e-12 * largest; };
  return int{vanishes(v.x)} + int{vanishes(v.y)} + int{vanishes(v.z)} == 2;
}

// Corner i of a cube has the bits of i as signs: bit 0 is x, bit 1 is y, bit 2 is z.
Vec3d cube_corner(unsigned i) {
  const auto sign = [&](unsigned bit) { return (i >> bit & 1u) != 0 ? 1.0 : -1.0; };
  return {sign(0), sign(1), sign(2)};
}

// Mesh of six faces, each with its own vertices and texture coordinates.
TriangleMesh cube_mesh() {
  constexpr std::array<std::array<unsigned, 4>, 6> kFaces{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  TriangleMesh mesh;
  for (const std::array<unsigned, 4>& face : kFaces) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const unsigned corner : face) mesh.positions.push_back(cube_corner(corner));
    mesh.uvs.insert(mesh.uvs.end(), {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }
  return mesh;
}

}  // namespace

void add_sphere(SceneWriter& scene, const Affined& map, double radius, double z_min, double z_max,
                const Sweep& sweep, const std::string& material) {
  const double low = std::clamp(std::min(z_min, z_max), -radius, radius);
  const double high = std::clamp(std::max(z_min, z_max), -radius, radius);
  if (low > -radius || high < radius || !sweep.is_full())
    return add_swept(scene, map, arcs_of(radius, std::asin(low / radius), std::asin(high / radius)), sweep,
                     material);
  if (const auto scale = uniform_scale(map))
    return scene.add_object({{"type", "sphere"},
                             {"material", material},
                             {"center", scene.point(map.origin)},
                             {"radius", radius * *scale}});
  if (!instance_parts(map))
    return add_swept(scene, map, arcs_of(radius, -std::numbers::pi / 2, std::numbers::pi / 2), sweep,
                     material);
  scene.add_placed({{"type", "sphere"}, {"material", material}, {"center", {0, 0, 0}}, {"radius", radius}},
                   map);
}

void add_disk(SceneWriter& scene, const Affined& map, double height, double radius, double inner_radius,
              const Sweep& sweep, const std::string& material) {
  const auto scale = uniform_scale(map);
  if (inner_radius > 0 || !sweep.is_full() || !scale)
    return add_swept(scene, map, {{{inner_radius, height, 1}, {radius, height, 1}}}, sweep, material);
  scene.add_object({{"type", "disk"},
                    {"material", material},
                    {"center", scene.point(map.point({0, 0, height}))},
                    {"normal", scene.direction(map.z)},
                    {"radius", radius * *scale}});
}

void add_cylinder(SceneWriter& scene, const Affined& map, double radius, double z_min, double z_max,
                  const Sweep& sweep, const std::string& material) {
  add_swept(scene, map, {{{radius, z_min, 1}, {radius, z_max, 1}}}, sweep, material);
}

void add_parallelogram(SceneWriter& scene, const Affined& map, const Vec3d& corner, const Vec3d& side_u,
                       const Vec3d& side_v, const std::string& material) {
  const Vec3d u = map.vector(side_u), v = map.vector(side_v);
  if (is_at_right_angles(u, v))
    return scene.add_object({{"type", "rectangle"},
                             {"material", material},
                             {"corner", scene.point(map.point(corner))},
                             {"edge_u", scene.point(u)},
                             {"edge_v", scene.point(v)}});
  TriangleMesh mesh;
  mesh.positions = {corner, corner + side_u, corner + side_u + side_v, corner + side_v};
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  add_triangles(scene, map, std::move(mesh), false, material);
}

void add_cube(SceneWriter& scene, const Affined& map, const std::string& material) {
  if (!is_along_axis(map.x) || !is_along_axis(map.y) || !is_along_axis(map.z) || !instance_parts(map))
    return add_triangles(scene, map, cube_mesh(), false, material);
  const Vec3d half = abs(map.x) + abs(map.y) + abs(map.z);
  scene.add_object({{"type", "box"},
                    {"material", material},
                    {"min", scene.point(map.origin - half)},
                    {"max", scene.point(map.origin + half)}});
}

void add_bilinear_patch(SceneWriter& scene, const Affined& map, const std::array<Vec3d, 4>& corners,
                        const std::string& material) {
  SceneJson points = SceneJson::array();
  for (const Vec3d& corner : corners) points.push_back(scene.point(map.point(corner)));
  scene.add_object({{"type", "patch"},
                    {"material", material},
                    {"degree_u", 1},
                    {"degree_v", 1},
                    {"points", std::move(points)}});
}

void add_triangles(SceneWriter& scene, const Affined& map, TriangleMesh mesh, bool reversed,
                   const std::string& material) {
  const bool turned = (scaled_determinant(map) < 0) != reversed;
  for (Vec3d& p : mesh.positions) p = map.point(p);
  for (Vec3d& n : mesh.normals) {
    n = safe_normalize(transformed_normal(map, n));
    if (reversed) n = -n;
  }
  if (turned)
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  scene.add_mesh(mesh, material);
}

double area_of(const TriangleMesh& mesh, const Affined& map) {
  double area = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    checkpoint(i);
    const auto corner = [&](std::size_t k) { return map.point(mesh.positions[mesh.triangles[i][k]]); };
    area += length(cross(corner(1) - corner(0), corner(2) - corner(0))) / 2;
  }
  return area;
}

}  // namespace orrery
