#pragma once

#include <limits>
#include <optional>

#include "core/model/packet.h"
#include "core/shapes/bezier_piece.h"

// Intersection of rays with pieces of Bezier patches.
//
// A point of the surface is on the ray if its coordinates across the ray, a and b, are 0. Both are
// polynomials of (u, v) whose Bezier nets follow from the control points (Nishita, Sederberg, Kakimoto, "Ray
// tracing trimmed rational surface patches", 1990). A piece whose nets are all on one side of the ray is
// missed. If the nets, multiplied by the inverse of their mean Jacobian matrix, differ from the identity by a
// contraction, the piece has at most one hit, and Newton's iteration from the centre finds it. Other pieces
// are halved until every part is missed, is such a piece, or is within the tolerance of the ray. The search
// is exhaustive up to kMaxParts parts. Grazing rays of a tube, a sphere and a torus use up to
// 2,500.
namespace orrery {

// Nearest hit of a ray and a piece. t is infinity for a miss. u and v are parameters of the piece.
template <class N>
struct BezierHit {
  N t, u, v;
};

namespace detail {

// Hits are within this many epsilon times (distance to the origin of the piece + its size) of the ray,
// grazing hits within twice as many. Rays through a common edge of two pieces hit one of them, because the
// coordinates across the ray are more exact.
inline constexpr int kBezierTolerance = 2;
inline constexpr int kMaxParts = 16'384;  // per ray and piece

// Nets across and along one ray.
template <class N>
struct RayNets {
  std::array<N, kMaxNet> a, b, t;  // times the weight
};

// Parts of a piece that wait for the search, as a stack.
template <class T>
struct BezierPart {
  RayNets<T> nets;
  std::array<T, kMaxNet> w;  // filled if the piece is rational
  T u0, du, v0, dv;
  int depth;
};

template <class N>
struct NetRange {
  N low, high;
};
template <class N>
[[gnu::always_inline]] inline NetRange<N> range_of(const std::array<N, kMaxNet>& net, std::size_t size) {
  NetRange<N> range{net[0], net[0]};
  for (std::size_t i = 1; i < size; ++i) {
    range.low = min_first(range.low, net[i]);
    range.high = max_first(range.high, net[i]);
  }
  return range;
}

// Returns true if some of the piece may be within `tolerance` of the ray and ahead of its origin.
template <class N>
[[gnu::always_inline]] inline MaskOf<N> may_contain_hit(const RayNets<N>& nets, std::size_t size,
                                                        const N& tolerance) {
  const NetRange<N> a = range_of(nets.a, size), b = range_of(nets.b, size);
  return a.low <= tolerance && a.high >= -tolerance && b.low <= tolerance && b.high >= -tolerance &&
         range_of(nets.t, size).high > N(ScalarOf<N>(0));
}

// Derivatives of a and b by u and v.
template <class N>
struct Jacobian {
  N au, av, bu, bv;

  N determinant() const { return au * bv - av * bu; }
  // Returns whether the matrix is not singular, up to rounding.
  MaskOf<N> regular() const {
    using std::abs;
    using T = ScalarOf<N>;
    const N a = max_first(N(abs(au)), N(abs(av))), b = max_first(N(abs(bu)), N(abs(bv)));
    return abs(determinant()) > a * b * (64 * std::numeric_limits<T>::epsilon());
  }
};

template <class N>
Jacobian<N> mean_jacobian(const RayNets<N>& nets, NetDegrees degrees) {
  using T = ScalarOf<N>;
  const std::size_t row = degrees.row(), rows = degrees.rows(), size = degrees.size();
  Jacobian<N> mean{N(T(0)), N(T(0)), N(T(0)), N(T(0))};
  for (std::size_t j = 0; j < size; j += row) {
    mean.au = mean.au + (nets.a[j + row - 1] - nets.a[j]);
    mean.bu = mean.bu + (nets.b[j + row - 1] - nets.b[j]);
  }
  for (std::size_t i = 0; i < row; ++i) {
    mean.av = mean.av + (nets.a[size - row + i] - nets.a[i]);
    mean.bv = mean.bv + (nets.b[size - row + i] - nets.b[i]);
  }
  const T over_rows = T(1) / static_cast<T>(rows), over_row = T(1) / static_cast<T>(row);
  return {mean.au * over_rows, mean.av * over_row, mean.bu * over_rows, mean.bv * over_row};
}

// Roots of (a, b) on [0, 1]^2, as far as the nets decide.
template <class N>
struct RootCount {
  MaskOf<N> possible;  // false: there is none
  MaskOf<N> simple;    // there is at most one, and newton_root() finds it
};

// Multiplies (a, b) by the adjugate of its mean Jacobian matrix J. There is no root if a component of the
// product has one sign. There is at most one root if the product over det J differs from the identity by a
// map with Lipschitz constant 1/5 in the maximum norm. Newton's iteration then halves the error or better.
template <class N>
RootCount<N> count_roots(const RayNets<N>& nets, NetDegrees degrees, const N& tolerance) {
  using std::abs;
  using T = ScalarOf<N>;
  const Jacobian<N> mean = mean_jacobian(nets, degrees);
  const std::size_t row = degrees.row(), size = degrees.size();
  std::array<N, kMaxNet> first, second;
  for (std::size_t i = 0; i < size; ++i) {
    first[i] = nets.a[i] * mean.bv - nets.b[i] * mean.av;
    second[i] = nets.b[i] * mean.au - nets.a[i] * mean.bu;
  }
  const NetRange<N> range = range_of(first, size), other = range_of(second, size);
  const N margin = tolerance * (abs(mean.bv) + abs(mean.av));
  const N other_margin = tolerance * (abs(mean.au) + abs(mean.bu));
  const MaskOf<N> possible = range.low <= margin && range.high >= -margin && other.low <= other_margin &&
                             other.high >= -other_margin;
  const MaskOf<N> regular = possible && mean.regular();
  if (!any(regular)) return {possible, regular};
  const N determinant = mean.determinant();
  const T m = static_cast<T>(degrees.u), n = static_cast<T>(degrees.v);
  N first_u(T(0)), first_v(T(0)), second_u(T(0)), second_v(T(0));
  for (std::size_t j = 0; j < size; j += row)
    for (std::size_t i = j; i + 1 < j + row; ++i) {
      first_u = max_first(first_u, N(abs((first[i + 1] - first[i]) * m - determinant)));
      second_u = max_first(second_u, N(abs((second[i + 1] - second[i]) * m)));
    }
  for (std::size_t i = 0; i + row < size; ++i) {
    first_v = max_first(first_v, N(abs((first[i + row] - first[i]) * n)));
    second_v = max_first(second_v, N(abs((second[i + row] - second[i]) * n - determinant)));
  }
  const N change = max_first(N(first_u + first_v), N(second_u + second_v));
  return {possible, regular && change < abs(determinant) * T(0.2)};
}

template <class N>
struct NetRoot {
  MaskOf<N> settled;
  N u, v;
};

// Finds the zero of (a, b) by Newton's iteration, if it is in [-1/8, 9/8]^2. Lanes without `active` are
// unspecified.
template <class N>
NetRoot<N> newton_root(const RayNets<N>& nets, NetDegrees degrees, MaskOf<N> active) {
  using std::abs;
  using std::sqrt;
  using T = ScalarOf<N>;
  constexpr int kMaxSteps = 10;
  const T enough = sqrt(std::numeric_limits<T>::epsilon()) / 16;  // the next step is below epsilon
  const N low(T(-0.125)), high(T(1.125));
  NetRoot<N> root{!active && active, N(T(0.5)), N(T(0.5))};
  for (int step = 0; step < kMaxSteps && any(active); ++step) {
    const NetValue<N> a = evaluate_net<N>(nets.a.data(), degrees, root.u, root.v);
    const NetValue<N> b = evaluate_net<N>(nets.b.data(), degrees, root.u, root.v);
    const N inverse = T(1) / (a.du * b.dv - a.dv * b.du);
    const N u = min_first(high, max_first(low, N(root.u - (a.value * b.dv - a.dv * b.value) * inverse)));
    const N v = min_first(high, max_first(low, N(root.v - (a.du * b.value - a.value * b.du) * inverse)));
    const MaskOf<N> done = max_first(N(abs(u - root.u)), N(abs(v - root.v))) < N(enough);
    root.u = select(active, u, root.u);
    root.v = select(active, v, root.v);
    root.settled = root.settled || (active && done);
    active = active && !done;
  }
  return root;
}

}  // namespace detail

// Rays against one piece.
template <class N>
class BezierRays {
  using T = ScalarOf<N>;

 public:
  BezierRays(const BezierPiece<T>& piece, const T* net, const Ray<N>& ray) : piece_(piece), net_(net) {
    const RayAxes<N> axes(ray.direction);
    const Shear<N> shear = Shear<N>::of(axes, ray.direction);
    const Vec3<N> x(N(T(1)), N(T(0)), N(T(0))), y(N(T(0)), N(T(1)), N(T(0))), z(N(T(0)), N(T(0)), N(T(1)));
    // Rows of the matrix that maps points to coordinates across and along the ray.
    const Vec3<N> along = select(axes.z_is_x, x, select(axes.z_is_y, y, z));
    across_a_ = select(axes.z_is_z, x, select(axes.z_is_x, y, z)) - along * shear.x;
    across_b_ = select(axes.z_is_y, x, select(axes.z_is_z, y, z)) - along * shear.y;
    along_ = along * (T(1) / shear.z);
    const Vec3<N> from = Vec3<N>(piece.origin) - ray.origin;
    a_ = dot(across_a_, from);
    b_ = dot(across_b_, from);
    t_ = dot(along_, from);
    tolerance_ = (max_component(abs(from)) + piece.reach) *
                 (piece.weight * (detail::kBezierTolerance * std::numeric_limits<T>::epsilon()));
  }

  BezierHit<N> hit() const {
    using std::abs;
    const N infinity(std::numeric_limits<T>::infinity());
    BezierHit<N> hit{infinity, N(T(0)), N(T(0))};
    // Rows across the ray are at most sqrt(2) long.
    const N reach = tolerance_ / piece_.weight + N(piece_.radius * T(1.4143));
    if (!any(abs(a_) <= reach && abs(b_) <= reach)) return hit;
    detail::RayNets<N> nets;
    fill(nets);
    const std::size_t size = piece_.degrees.size();
    MaskOf<N> possible = detail::may_contain_hit(nets, size, tolerance_);
    if (!any(possible)) return hit;
    const detail::RootCount<N> count = detail::count_roots(nets, piece_.degrees, tolerance_);
    possible = possible && count.possible;
    const MaskOf<N> simple = possible && count.simple;
    const detail::NetRoot<N> root = detail::newton_root(nets, piece_.degrees, simple);
    accept(nets, root.u, root.v, simple && root.settled, hit);
    const MaskOf<N> rest = possible && !(simple && root.settled);
    if (any(rest)) search_lanes(nets, rest, hit);
    return hit;
  }

 private:
  void fill(detail::RayNets<N>& nets) const {
    const std::size_t size = piece_.degrees.size();
    for (std::size_t i = 0; i < size; ++i) {
      const Vec3<N> p(N(net_[i]), N(net_[size + i]), N(net_[2 * size + i]));
      const N w = piece_.rational ? N(net_[3 * size + i]) : N(T(1));
      nets.a[i] = dot(across_a_, p) + a_ * w;
      nets.b[i] = dot(across_b_, p) + b_ * w;
      nets.t[i] = dot(along_, p) + t_ * w;
    }
  }

  // Moves (u, v) into the piece. Stores the hit there if it is within the tolerance of the ray, ahead of the
  // origin and nearer than `hit`.
  template <class M>
  void accept(const detail::RayNets<M>& nets, const M& root_u, const M& root_v, const MaskOf<M>& active,
              BezierHit<M>& hit, const M& tolerance) const {
    using std::abs;
    if (!any(active)) return;
    const M u = min_first(M(T(1)), max_first(M(T(0)), root_u)),
            v = min_first(M(T(1)), max_first(M(T(0)), root_v));
    const auto at = [&](const M* net) { return evaluate_net<M>(net, piece_.degrees, u, v).value; };
    M t = at(nets.t.data());
    if (piece_.rational)
      t = t / evaluate_net<M>(net_ + 3 * piece_.degrees.size(), piece_.degrees, u, v).value;
    const MaskOf<M> better = active && abs(at(nets.a.data())) <= tolerance &&
                             abs(at(nets.b.data())) <= tolerance && t > M(T(0)) && t < hit.t;
    hit = {select(better, t, hit.t), select(better, u, hit.u), select(better, v, hit.v)};
  }
  void accept(const detail::RayNets<N>& nets, const N& u, const N& v, const MaskOf<N>& active,
              BezierHit<N>& hit) const {
    accept(nets, u, v, active, hit, tolerance_);
  }

  void search_lanes(const detail::RayNets<N>& nets, const MaskOf<N>& lanes, BezierHit<N>& hit) const {
    if constexpr (std::is_arithmetic_v<N>) {
      search(nets, tolerance_, hit);
    } else {
      detail::RayNets<T> one;
      for (std::size_t lane = 0; lane < N::size(); ++lane) {
        if (!lanes[lane]) continue;
        for (std::size_t i = 0; i < piece_.degrees.size(); ++i) {
          one.a[i] = nets.a[i][lane];
          one.b[i] = nets.b[i][lane];
          one.t[i] = nets.t[i][lane];
        }
        BezierHit<T> found{std::numeric_limits<T>::infinity(), T(0), T(0)};
        search(one, tolerance_[lane], found);
        hit.t[lane] = found.t;
        hit.u[lane] = found.u;
        hit.v[lane] = found.v;
      }
    }
  }

  // Returns whether all of the part is farther than t.
  bool beyond(const detail::BezierPart<T>& part, T t) const {
    for (std::size_t i = 0; i < piece_.degrees.size(); ++i)
      if (part.nets.t[i] < (piece_.rational ? t * part.w[i] : t)) return false;
    return true;
  }

  // Finds the nearest hit by halving, the nearer half first.
  void search(const detail::RayNets<T>& nets, T tolerance, BezierHit<T>& hit) const {
    using Part = detail::BezierPart<T>;
    // A part of this depth is smaller than the tolerance, unless rounding prevents it.
    constexpr int kMaxDepth = 2 * std::numeric_limits<T>::digits + 8;
    std::array<Part, kMaxDepth + 2> stack;
    const std::size_t size = piece_.degrees.size();
    std::size_t count = 1;
    stack[0].nets = nets;
    if (piece_.rational) std::copy_n(net_ + 3 * size, size, stack[0].w.begin());
    stack[0].u0 = stack[0].v0 = 0;
    stack[0].du = stack[0].dv = 1;
    stack[0].depth = 0;
    for (int parts = 0; count > 0 && parts < detail::kMaxParts; ++parts) {
      Part& part = stack[count - 1];
      if (!detail::may_contain_hit(part.nets, size, tolerance) || beyond(part, hit.t)) {
        --count;
        continue;
      }
      const auto take = [&](T u, T v, T slack) {
        accept<T>(nets, part.u0 + part.du * u, part.v0 + part.dv * v, true, hit, tolerance * slack);
      };
      if (std::optional<std::array<T, 2>> at = thin_root(part, tolerance)) {
        take((*at)[0], (*at)[1], 4);
        --count;
        continue;
      }
      const bool along_u = splits_along_u(part);
      if (part.depth == kMaxDepth || extent(part, along_u) <= tolerance) {
        take(T(0.5), T(0.5), 4);  // the net is within 2 tolerances of 0
        --count;
        continue;
      }
      const detail::RootCount<T> roots = detail::count_roots(part.nets, piece_.degrees, tolerance);
      if (!roots.possible) {
        --count;
        continue;
      }
      if (roots.simple) {
        const detail::NetRoot<T> root = detail::newton_root<T>(part.nets, piece_.degrees, true);
        if (root.settled) {
          if (within_part(root.u) && within_part(root.v)) take(root.u, root.v, 1);
          --count;
          continue;
        }
      }
      halve(part, stack[count], along_u);
      ++count;
    }
  }

  // Across the ray, a part near a tangent point is as thin as the tolerance long before it is as short. If
  // the part is within twice the tolerance of a line across the ray, and its corners are on both sides of the
  // ray, returns a point of the part nearest to the ray.
  std::optional<std::array<T, 2>> thin_root(const detail::BezierPart<T>& part, T tolerance) const {
    const NetDegrees degrees = piece_.degrees;
    const std::size_t row = degrees.row(), size = degrees.size();
    const detail::Jacobian<T> mean = detail::mean_jacobian(part.nets, degrees);
    const T by_u = std::abs(mean.au) + std::abs(mean.bu), by_v = std::abs(mean.av) + std::abs(mean.bv);
    const T da = by_u > by_v ? mean.au : mean.av, db = by_u > by_v ? mean.bu : mean.bv;
    const T margin = 2 * tolerance * (std::abs(da) + std::abs(db));
    for (std::size_t i = 0; i < size; ++i)
      if (!(std::abs(part.nets.a[i] * db - part.nets.b[i] * da) <= margin)) return std::nullopt;
    const auto along = [&](T u, T v) {
      return evaluate_net<T>(part.nets.a.data(), degrees, u, v).value * da +
             evaluate_net<T>(part.nets.b.data(), degrees, u, v).value * db;
    };
    std::array<T, 2> below{}, above{};
    int signs = 0;
    for (const std::size_t corner : {std::size_t{0}, row - 1, size - row, size - 1}) {
      const std::array<T, 2> at{T(corner % row != 0), T(corner >= row)};
      const bool negative = part.nets.a[corner] * da + part.nets.b[corner] * db < 0;
      (negative ? below : above) = at;
      signs |= negative ? 1 : 2;
    }
    if (signs != 3) return std::nullopt;
    const auto between = [&](T x) {
      return std::array<T, 2>{interpolate(below[0], above[0], x), interpolate(below[1], above[1], x)};
    };
    T low = 0, high = 1;
    for (int step = 0; step < std::numeric_limits<T>::digits; ++step) {
      const T middle = (low + high) / 2;
      const std::array<T, 2> at = between(middle);
      (along(at[0], at[1]) < 0 ? low : high) = middle;
    }
    return between(high);
  }

  // Returns whether a root may be in the part, up to rounding. Roots outside the part belong to its
  // neighbours.
  static bool within_part(T x) {
    const T slack = std::sqrt(std::numeric_limits<T>::epsilon());
    return x >= -slack && x <= 1 + slack;
  }

  static T largest_step(const std::array<T, kMaxNet>& net, NetDegrees degrees, bool along_u) {
    const std::size_t row = degrees.row(), size = degrees.size(), step = along_u ? 1 : row;
    T largest = 0;
    for (std::size_t i = 0; i + step < size; ++i)
      if (!along_u || (i + 1) % row != 0) largest = std::max(largest, std::abs(net[i + step] - net[i]));
    return largest * static_cast<T>(along_u ? degrees.u : degrees.v);
  }
  // Returns an upper bound of the size of the part across the ray, along u or v.
  T extent(const detail::BezierPart<T>& part, bool along_u) const {
    return std::max(largest_step(part.nets.a, piece_.degrees, along_u),
                    largest_step(part.nets.b, piece_.degrees, along_u));
  }
  bool splits_along_u(const detail::BezierPart<T>& part) const {
    return extent(part, true) >= extent(part, false);
  }

  // Replaces `part` by its farther half, and stores the nearer half in `next`.
  void halve(detail::BezierPart<T>& part, detail::BezierPart<T>& next, bool along_u) const {
    const NetDegrees degrees = piece_.degrees;
    next.nets.a = part.nets.a;
    split_net(part.nets.a.data(), next.nets.a.data(), degrees, along_u);
    split_net(part.nets.b.data(), next.nets.b.data(), degrees, along_u);
    split_net(part.nets.t.data(), next.nets.t.data(), degrees, along_u);
    if (piece_.rational) split_net(part.w.data(), next.w.data(), degrees, along_u);
    ++part.depth;
    next.u0 = part.u0, next.v0 = part.v0;
    if (along_u) {
      part.du /= 2;
      next.u0 += part.du;
    } else {
      part.dv /= 2;
      next.v0 += part.dv;
    }
    next.du = part.du, next.dv = part.dv, next.depth = part.depth;
    if (near(part) < near(next)) std::swap(part, next);
  }
  T near(const detail::BezierPart<T>& part) const {
    return detail::range_of(part.nets.t, piece_.degrees.size()).low;
  }

  const BezierPiece<T>& piece_;
  const T* net_;
  Vec3<N> across_a_, across_b_, along_;
  N a_, b_, t_;
  N tolerance_;  // bound of coordinates times weights
};

}  // namespace orrery
