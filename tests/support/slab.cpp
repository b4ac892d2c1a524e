#include "tests/support/slab.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

namespace orrery::test {
namespace {

// Square matrix of fluxes: element (i, j) is the fraction of the flux in direction j that leaves in
// direction i.
class Matrix {
 public:
  explicit Matrix(std::size_t n, double diagonal = 0) : n_(n), values_(n * n) {
    for (std::size_t i = 0; i < n; ++i) at(i, i) = diagonal;
  }
  std::size_t size() const { return n_; }
  double& at(std::size_t i, std::size_t j) { return values_[i * n_ + j]; }
  double at(std::size_t i, std::size_t j) const { return values_[i * n_ + j]; }

  Matrix operator*(const Matrix& o) const {
    Matrix product(n_);
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t k = 0; k < n_; ++k)
        for (std::size_t j = 0; j < n_; ++j) product.at(i, j) += at(i, k) * o.at(k, j);
    return product;
  }
  Matrix operator+(const Matrix& o) const {
    Matrix sum = *this;
    for (std::size_t k = 0; k < values_.size(); ++k) sum.values_[k] += o.values_[k];
    return sum;
  }

 private:
  std::size_t n_;
  std::vector<double> values_;
};

// Returns (1 - a)^-1 b by Gaussian elimination with pivoting.
Matrix solved(const Matrix& a, Matrix b) {
  const std::size_t n = a.size();
  Matrix m(n, 1);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) m.at(i, j) -= a.at(i, j);
  for (std::size_t column = 0; column < n; ++column) {
    std::size_t pivot = column;
    for (std::size_t i = column + 1; i < n; ++i)
      if (std::abs(m.at(i, column)) > std::abs(m.at(pivot, column))) pivot = i;
    for (std::size_t j = 0; j < n; ++j) {
      std::swap(m.at(pivot, j), m.at(column, j));
      std::swap(b.at(pivot, j), b.at(column, j));
    }
    for (std::size_t i = 0; i < n; ++i) {
      if (i == column || m.at(i, column) == 0) continue;
      const double factor = m.at(i, column) / m.at(column, column);
      for (std::size_t j = column; j < n; ++j) m.at(i, j) -= factor * m.at(column, j);
      for (std::size_t j = 0; j < n; ++j) b.at(i, j) -= factor * b.at(column, j);
    }
  }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) b.at(i, j) /= m.at(i, i);
  return b;
}

// Legendre polynomial of this degree, and its derivative.
std::pair<double, double> legendre(int degree, double x) {
  double before = 1, last = x;
  if (degree == 0) return {1, 0};
  for (int k = 2; k <= degree; ++k)
    before = std::exchange(last, ((2 * k - 1) * x * last - (k - 1) * before) / k);
  return {last, degree * (x * last - before) / (x * x - 1)};
}

struct Ordinates {
  std::vector<double> cosine, weight;

  // Adds Gauss's nodes of an interval.
  void add(double from, double to, int count) {
    for (int i = 0; i < count; ++i) {
      double x = std::cos(std::numbers::pi * (i + 0.75) / (count + 0.5));
      for (int step = 0; step < 100; ++step) {
        const auto [value, slope] = legendre(count, x);
        x -= value / slope;
      }
      const double slope = legendre(count, x).second;
      cosine.push_back(from + (to - from) * (x + 1) / 2);
      weight.push_back((to - from) / ((1 - x * x) * slope * slope));
    }
  }
};

// Fresnel reflectance of unpolarized light that meets the surface from inside.
double inner_reflectance(double index, double cosine) {
  const double other2 = 1 - index * index * (1 - cosine * cosine);
  if (other2 <= 0) return 1;
  const double other = std::sqrt(other2);
  const double s = (index * cosine - other) / (index * cosine + other),
               p = (cosine - index * other) / (cosine + index * other);
  return (s * s + p * p) / 2;
}

struct Layer {
  Matrix reflected, transmitted;
};

// Returns a layer so thin that light is scattered at most once. The columns are normalized, so that light
// without absorption keeps its flux exactly.
Layer thin_layer(const Ordinates& nodes, const SlabMedium& medium, double thickness) {
  constexpr int kTerms = 120;
  const std::size_t n = nodes.cosine.size();
  Layer layer{Matrix(n), Matrix(n)};
  for (std::size_t j = 0; j < n; ++j) {
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
      double forward = 0, backward = 0, power = 1;
      for (int l = 0; l < kTerms; ++l, power *= medium.anisotropy) {
        const double term =
            (2 * l + 1) * power * legendre(l, nodes.cosine[i]).first * legendre(l, nodes.cosine[j]).first;
        forward += term;
        backward += l % 2 == 0 ? term : -term;
      }
      layer.transmitted.at(i, j) = nodes.weight[i] * forward;
      layer.reflected.at(i, j) = nodes.weight[i] * backward;
      sum += nodes.weight[i] * (forward + backward);
    }
    const double removed = thickness / nodes.cosine[j], scale = medium.albedo * removed / sum;
    for (std::size_t i = 0; i < n; ++i) {
      layer.transmitted.at(i, j) *= scale;
      layer.reflected.at(i, j) *= scale;
    }
    layer.transmitted.at(j, j) += 1 - removed;
  }
  return layer;
}

// Returns two equal layers on top of each other.
Layer doubled(const Layer& one) {
  const Matrix between = solved(one.reflected * one.reflected, one.transmitted);
  return {one.reflected + one.transmitted * (one.reflected * between), one.transmitted * between};
}

}  // namespace

SlabShares slab_shares(const SlabMedium& medium) {
  constexpr int kDoublings = 28, kNodes = 24;
  const double critical = std::sqrt(1 - 1 / (medium.index * medium.index));
  Ordinates nodes;
  if (critical > 0) nodes.add(0, critical, kNodes);
  nodes.add(critical, 1, kNodes);
  nodes.cosine.push_back(1);  // the beam
  nodes.weight.push_back(0);
  const std::size_t n = nodes.cosine.size(), beam = n - 1;
  Layer slab = thin_layer(nodes, medium, std::ldexp(medium.thickness, -kDoublings));
  for (int i = 0; i < kDoublings; ++i) slab = doubled(slab);

  Matrix mirror(n);
  for (std::size_t i = 0; i < n; ++i) mirror.at(i, i) = inner_reflectance(medium.index, nodes.cosine[i]);
  const Matrix down = solved(slab.reflected * mirror, slab.transmitted);  // at the lower side
  const Matrix up = slab.reflected + slab.transmitted * (mirror * down);
  const Matrix inside = solved(mirror * up, Matrix(n, 1));
  const Matrix out = up * inside, through = down * inside;
  const double outer = mirror.at(beam, beam);
  SlabShares shares{outer, 0};
  for (std::size_t i = 0; i < n; ++i) {
    const double leaves = (1 - outer) * (1 - mirror.at(i, i));
    shares.reflected += leaves * out.at(i, beam);
    shares.transmitted += leaves * through.at(i, beam);
  }
  return shares;
}

}  // namespace orrery::test
