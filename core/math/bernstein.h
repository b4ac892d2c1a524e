#pragma once

#include <array>
#include <cstddef>

#include "core/math/lanes.h"

// Tensor product polynomials in Bernstein form on [0, 1] x [0, 1]. The coefficient of B_i(u) B_j(v) is
// net[j * (degrees.u + 1) + i]. De Casteljau's algorithm evaluates and splits them. Its results are convex
// combinations of coefficients, so their errors are a few rounding units of the largest coefficient.
namespace orrery {

inline constexpr int kMaxBezierDegree = 7;
inline constexpr std::size_t kMaxNet = (kMaxBezierDegree + 1) * (kMaxBezierDegree + 1);

struct NetDegrees {
  int u, v;  // 1 to kMaxBezierDegree
  constexpr std::size_t row() const { return static_cast<std::size_t>(u) + 1; }
  constexpr std::size_t rows() const { return static_cast<std::size_t>(v) + 1; }
  constexpr std::size_t size() const { return row() * rows(); }
};

// Value and partial derivatives.
template <class N>
struct NetValue {
  N value, du, dv;
};

template <class N>
[[gnu::always_inline]] inline N interpolate(const N& a, const N& b, const N& t) {
  return a + (b - a) * t;
}

// Evaluates a net of F, which is N or the scalar type of N.
template <class N, class F>
[[gnu::always_inline]] inline NetValue<N> evaluate_net(const F* net, NetDegrees degrees, const N& u,
                                                       const N& v) {
  using T = ScalarOf<N>;
  std::array<N, kMaxBezierDegree + 1> values, slopes, row;
  const std::size_t m = degrees.row() - 1, n = degrees.rows() - 1;
  for (std::size_t j = 0; j <= n; ++j) {
    for (std::size_t i = 0; i <= m; ++i) row[i] = N(net[j * (m + 1) + i]);
    for (std::size_t last = m; last > 1; --last)
      for (std::size_t i = 0; i < last; ++i) row[i] = interpolate(row[i], row[i + 1], u);
    slopes[j] = row[1] - row[0];
    values[j] = interpolate(row[0], row[1], u);
  }
  for (std::size_t last = n; last > 1; --last)
    for (std::size_t j = 0; j < last; ++j) {
      values[j] = interpolate(values[j], values[j + 1], v);
      slopes[j] = interpolate(slopes[j], slopes[j + 1], v);
    }
  return {interpolate(values[0], values[1], v),
          interpolate(slopes[0], slopes[1], v) * static_cast<T>(degrees.u),
          (values[1] - values[0]) * static_cast<T>(degrees.v)};
}

// Splits the net at 1/2 along u or v. The first half replaces `net`.
template <class F>
void split_net(F* net, F* second, NetDegrees degrees, bool along_u) {
  const std::size_t count = along_u ? degrees.row() : degrees.rows(), lines = degrees.size() / count;
  const std::size_t step = along_u ? 1 : degrees.row(), next_line = along_u ? degrees.row() : 1;
  for (std::size_t line = 0; line < lines; ++line, net += next_line, second += next_line)
    for (std::size_t done = 0; done < count; ++done) {
      const std::size_t last = count - 1 - done;
      second[last * step] = net[(count - 1) * step];
      for (std::size_t i = count - 1; i > done; --i)
        net[i * step] = (net[(i - 1) * step] + net[i * step]) * F(0.5);
    }
}

}  // namespace orrery
