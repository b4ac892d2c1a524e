#include "core/accelerators/oriented_box.h"

namespace orrery {
namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

// Rotates rows and columns p and q of the symmetric `m` so that m[p][q] becomes 0. Rotates `axes` accordingly
// (Jacobi 1846; Golub and Van Loan, "Matrix Computations", 8.5).
void rotate(Matrix& m, Matrix& axes, std::size_t p, std::size_t q) {
  if (m[p][q] == 0) return;
  const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
  const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::hypot(theta, 1.0));
  const double c = 1 / std::hypot(t, 1.0), s = t * c;
  for (std::size_t k = 0; k < 3; ++k) {
    const double kp = m[k][p], kq = m[k][q];
    m[k][p] = c * kp - s * kq;
    m[k][q] = s * kp + c * kq;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const double pk = m[p][k], qk = m[q][k];
    m[p][k] = c * pk - s * qk;
    m[q][k] = s * pk + c * qk;
  }
  m[p][q] = m[q][p] = 0;
  for (auto& row : axes) {
    const double kp = row[p], kq = row[q];
    row[p] = c * kp - s * kq;
    row[q] = s * kp + c * kq;
  }
}

}  // namespace

void SurfaceMoments::add(const HullTriangle& triangle) {
  const Vec3d& a = triangle[0];
  const Vec3d& b = triangle[1];
  const Vec3d& c = triangle[2];
  const double size = length(cross(b - a, c - a)) / 2;
  const Vec3d sum = a + b + c;
  area += size;
  first = first + sum * (size / 3);
  const auto integral = [&](double Vec3d::*i, double Vec3d::*j) {
    return size / 12 * (sum.*i * sum.*j + a.*i * a.*j + b.*i * b.*j + c.*i * c.*j);
  };
  second[0] += integral(&Vec3d::x, &Vec3d::x);
  second[1] += integral(&Vec3d::y, &Vec3d::y);
  second[2] += integral(&Vec3d::z, &Vec3d::z);
  second[3] += integral(&Vec3d::x, &Vec3d::y);
  second[4] += integral(&Vec3d::x, &Vec3d::z);
  second[5] += integral(&Vec3d::y, &Vec3d::z);
}

void SurfaceMoments::add(const SurfaceMoments& other) {
  area += other.area;
  first = first + other.first;
  for (std::size_t i = 0; i < second.size(); ++i) second[i] += other.second[i];
}

std::array<Vec3d, 3> principal_axes(const SurfaceMoments& moments) {
  Matrix m{}, axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  if (moments.area > 0) {
    const Vec3d mean = moments.first / moments.area;
    const auto& s = moments.second;
    const auto covariance = [&](double sum, double i, double j) { return sum / moments.area - i * j; };
    m = {{{covariance(s[0], mean.x, mean.x), covariance(s[3], mean.x, mean.y),
           covariance(s[4], mean.x, mean.z)},
          {0, covariance(s[1], mean.y, mean.y), covariance(s[5], mean.y, mean.z)},
          {0, 0, covariance(s[2], mean.z, mean.z)}}};
    // Clears entries that consist of rounding errors only.
    const double noise = 1e-12 * (m[0][0] + m[1][1] + m[2][2]);
    for (const auto& [i, j] : {std::pair<std::size_t, std::size_t>{0, 1}, {0, 2}, {1, 2}})
      m[j][i] = m[i][j] = std::abs(m[i][j]) > noise ? m[i][j] : 0;
  }
  constexpr int kSweeps = 12;  // converges quadratically
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    rotate(m, axes, 0, 1);
    rotate(m, axes, 0, 2);
    rotate(m, axes, 1, 2);
  }
  std::array<Vec3d, 3> columns;
  for (std::size_t i = 0; i < 3; ++i) columns[i] = {axes[0][i], axes[1][i], axes[2][i]};
  return columns;
}

std::vector<HullTriangle> sides_of(const Boundsd& box) {
  const Vec3d size = box.hi - box.lo;
  const std::array<Vec3d, 3> edges{Vec3d(size.x, 0, 0), Vec3d(0, size.y, 0), Vec3d(0, 0, size.z)};
  std::vector<HullTriangle> sides;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Vec3d u = edges[(axis + 1) % 3], v = edges[(axis + 2) % 3];
    for (const Vec3d& corner : {box.lo, box.lo + edges[axis]}) {
      sides.push_back({corner, corner + u, corner + u + v});
      sides.push_back({corner, corner + u + v, corner + v});
    }
  }
  return sides;
}

template <class T>
OrientedBox<T> OrientedBox<T>::around(const std::array<Vec3d, 3>& axes, std::span<const HullTriangle> hull) {
  OrientedBox oriented;
  Boundsd all;
  for (const auto& triangle : hull)
    for (const Vec3d& corner : triangle) all.include(corner);
  oriented.center = Vec3<T>(all.lo * 0.5 + all.hi * 0.5);
  for (std::size_t i = 0; i < 3; ++i) oriented.axes[i] = Vec3<T>(axes[i]);
  const Vec3d center(oriented.center);
  const std::array<Vec3d, 3> rounded{Vec3d(oriented.axes[0]), Vec3d(oriented.axes[1]),
                                     Vec3d(oriented.axes[2])};
  Boundsd box;
  for (const auto& triangle : hull)
    for (const Vec3d& corner : triangle) {
      const Vec3d from = corner - center;
      box.include(Vec3d(dot(rounded[0], from), dot(rounded[1], from), dot(rounded[2], from)));
    }
  const double pad = 2 * double{kRounding<T>} * (all.magnitude() + box.magnitude());
  oriented.box.lo = Vec3<T>(box.lo - Vec3d(pad));
  oriented.box.hi = Vec3<T>(box.hi + Vec3d(pad));
  return oriented;
}

template struct OrientedBox<float>;
template struct OrientedBox<double>;

}  // namespace orrery
