#pragma once

#include <vector>

#include "core/math/bernstein.h"
#include "core/math/bounds.h"

namespace orrery {

// Rational Bezier patch in double precision. `net` contains the coefficients of x w, y w, z w and w, one net
// after another, relative to `origin`. Weights are positive.
struct BezierPatch {
  NetDegrees degrees;
  bool rational;  // false: all weights are 1
  Vec3d origin;
  std::vector<double> net;
  double u0, u1, v0, v1;  // part of the object's parameter square

  std::size_t size() const { return degrees.size(); }
  double weight(std::size_t i) const { return net[3 * size() + i]; }
  // Returns control point i relative to `origin`.
  Vec3d point(std::size_t i) const { return Vec3d(net[i], net[size() + i], net[2 * size() + i]) / weight(i); }
};

// Piece of a patch in the render's precision, without its net.
template <class T>
struct BezierPiece {
  NetDegrees degrees;
  bool rational;
  std::size_t first;  // index of its net in BezierTable::nets
  Vec3<T> origin;
  T radius;  // radius of a sphere around `origin` that contains the control points
  T reach;   // largest absolute coordinate of a control point, relative to `origin`
  T weight;  // largest weight
  T u0, u1, v0, v1;
  T magnitude;  // largest absolute coordinate of the control points of the object
};

// Pieces and their nets: x w, y w, z w, and w if the piece is rational.
template <class T>
struct BezierTable {
  std::vector<BezierPiece<T>> pieces;
  std::vector<T> nets;

  const T* net(std::size_t i) const { return nets.data() + pieces[i].first; }
};

}  // namespace orrery
