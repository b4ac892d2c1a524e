#include "core/meshes/polygons.h"

#include <array>

#include "core/base/shorten.h"
#include "core/base/task_scope.h"

namespace orrery {
namespace {

constexpr std::uint32_t kMostCorners = 4096;
// Maximum number of tests of corners against triangles in one file, which take about 2 s. Clipping a polygon
// takes up to corners^3 / 6 tests.
constexpr std::uint64_t kMostTests = 1'000'000'000;

struct Point {
  double x, y;
  bool operator==(const Point&) const = default;
};

// Returns twice the signed area of a triangle: positive if anticlockwise.
double area(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Polygon in its own plane, anticlockwise. Clips ears until a triangle is left.
class Polygon {
 public:
  // Reads the corners of a fan.
  void read(const TriangleMesh& mesh, const Fan& fan) {
    corners_.clear();
    corners_.push_back(mesh.triangles[fan.first][0]);
    corners_.push_back(mesh.triangles[fan.first][1]);
    for (std::uint32_t i = 0; i + 2 < fan.count; ++i) corners_.push_back(mesh.triangles[fan.first + i][2]);
    project(mesh.positions);
  }

  // Returns whether the fan covers the polygon: no corner is reflex, and the edges turn once.
  bool is_convex() const {
    int turns_in_x = 0;
    double before = 0;
    const std::size_t n = corners_.size();
    for (std::size_t i = 0; i < 2 * n; ++i) {
      const Point &a = points_[i % n], &b = points_[(i + 1) % n];
      if (i < n && area(a, b, points_[(i + 2) % n]) < 0) return false;
      const double along = b.x - a.x;
      if (along == 0) continue;
      if (i >= n && along * before < 0) ++turns_in_x;
      before = along;
    }
    return turns_in_x <= 2;
  }

  // Returns whether two edges cross at an inner point of both.
  bool crosses_itself() const {
    const std::size_t n = points_.size();
    for (std::size_t i = 0; i < n; ++i) {
      checkpoint();
      const Point &a = points_[i], &b = points_[(i + 1) % n];
      for (std::size_t k = i + 2; k < n; ++k) {
        const Point &c = points_[k], &d = points_[(k + 1) % n];
        if (area(a, b, c) * area(a, b, d) < 0 && area(c, d, a) * area(c, d, b) < 0) return true;
      }
    }
    return false;
  }

  // Calls add(a, b, c) for each triangle.
  template <class Add>
  void clip(const Add& add) {
    link();
    std::uint32_t at = 0, tried = 0, left = static_cast<std::uint32_t>(corners_.size());
    while (left > 3) {
      checkpoint();
      if (tried < left && tests_ < kMostTests &&
          !is_ear(at)) {  // without any ear, the polygon crosses itself: cut off a corner
        at = next_[at];
        ++tried;
        continue;
      }
      add(corners_[before_[at]], corners_[at], corners_[next_[at]]);
      unlink(at);
      at = next_[at];
      --left;
      tried = 0;
    }
    add(corners_[before_[at]], corners_[at], corners_[next_[at]]);
  }

  bool has_tests_left() const { return tests_ < kMostTests; }

 private:
  void project(const std::vector<Vec3d>& positions) {
    Vec3d normal, last = positions[corners_.back()] - positions[corners_.front()];
    for (const std::uint32_t corner : corners_) {
      const Vec3d at = positions[corner] - positions[corners_.front()];
      normal = normal + cross(last, at);
      last = at;
    }
    // The two axes with the largest projected area, in an order that keeps the polygon anticlockwise.
    const Vec3d size = abs(normal);
    const int dropped = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto component = [](const Vec3d& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; };
    const bool flips = component(normal, dropped) < 0;
    points_.clear();
    for (const std::uint32_t corner : corners_) {
      const Vec3d& at = positions[corner];
      const double u = component(at, (dropped + 1) % 3), v = component(at, (dropped + 2) % 3);
      points_.push_back(flips ? Point{v, u} : Point{u, v});
    }
  }

  void link() {
    const auto n = static_cast<std::uint32_t>(corners_.size());
    before_.resize(n);
    next_.resize(n);
    for (std::uint32_t i = 0; i < n; ++i) {
      before_[i] = (i + n - 1) % n;
      next_[i] = (i + 1) % n;
    }
    reflex_.clear();
    for (std::uint32_t i = 0; i < n; ++i)
      if (area_at(i) <= 0) reflex_.push_back(i);
  }
  void unlink(std::uint32_t corner) {
    next_[before_[corner]] = next_[corner];
    before_[next_[corner]] = before_[corner];
    // Clipping an ear makes no other corner reflex, and may make its neighbours convex.
    std::erase_if(reflex_, [&](std::uint32_t i) {
      return i == corner || ((i == before_[corner] || i == next_[corner]) && area_at(i) > 0);
    });
  }
  double area_at(std::uint32_t i) const { return area(points_[before_[i]], points_[i], points_[next_[i]]); }

  // Returns whether the corner is convex and its triangle contains no other corner. Corners at the place of
  // one of its own corners do not count, because bridges to holes use corners twice.
  bool is_ear(std::uint32_t corner) {
    const std::uint32_t before = before_[corner], next = next_[corner];
    const Point &a = points_[before], &b = points_[corner], &c = points_[next];
    if (!(area(a, b, c) > 0)) return false;
    tests_ += reflex_.size();
    for (const std::uint32_t i : reflex_) {
      const Point& p = points_[i];
      if (i == before || i == corner || i == next || p == a || p == b || p == c) continue;
      if (area(a, b, p) >= 0 && area(b, c, p) >= 0 && area(c, a, p) >= 0) return false;
    }
    return true;
  }

  std::vector<std::uint32_t> corners_;  // vertices of the mesh
  std::vector<Point> points_;
  std::vector<std::uint32_t> before_, next_;  // neighbours of the corners that are left
  std::vector<std::uint32_t> reflex_;         // corners that are left and not convex
  std::uint64_t tests_ = 0;                   // calls of area() for ears of all polygons, at most
};

}  // namespace

void divide_polygons(const std::vector<Fan>& fans, TriangleMesh& mesh) {
  Polygon polygon;
  std::size_t crossed = 0, large = 0;
  for (const Fan& fan : fans) {
    checkpoint();
    polygon.read(mesh, fan);
    if (polygon.is_convex()) continue;
    if (fan.count > kMostCorners || !polygon.has_tests_left()) {
      ++large;
      continue;
    }
    std::uint32_t triangle = fan.first;
    if (polygon.crosses_itself()) ++crossed;
    polygon.clip([&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      mesh.triangles[triangle++] = {a, b, c};
    });
    if (!polygon.has_tests_left()) ++large;
  }
  if (crossed > 0)
    mesh.notes.push_back(grouped(crossed) + " polygons cross themselves; their triangles may overlap");
  if (large > 0)
    mesh.notes.push_back(grouped(large) + " concave polygons have too many corners (limit " +
                         grouped(kMostCorners) +
                         ", and fewer in files with many); their triangles may overlap");
}

}  // namespace orrery
