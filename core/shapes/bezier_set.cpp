#include "core/shapes/bezier_set.h"

#include <cmath>

#include "core/base/shorten.h"
#include "core/model/tessellation.h"
#include "core/params/params.h"

namespace orrery {
namespace {

// Returns the box of the control points, relative to the origin of the patch.
Boundsd local_box_of(const BezierPatch& patch) {
  Boundsd box;
  for (std::size_t i = 0; i < patch.size(); ++i) box.include(patch.point(i));
  return box;
}
Boundsd box_of(const BezierPatch& patch) {
  const Boundsd local = local_box_of(patch);
  return Boundsd::of({patch.origin + local.lo, patch.origin + local.hi});
}

template <class T>
BezierPiece<T> piece_of(const BezierPatch& patch, std::size_t first, double magnitude) {
  double radius = 0, reach = 0, weight = 0;
  for (std::size_t i = 0; i < patch.size(); ++i) {
    radius = std::max(radius, length(patch.point(i)));
    reach = std::max(reach, max_component(abs(patch.point(i))));
    weight = std::max(weight, patch.weight(i));
  }
  return {patch.degrees,
          patch.rational,
          first,
          Vec3<T>(patch.origin),
          static_cast<T>(radius),
          static_cast<T>(reach),
          static_cast<T>(weight),
          static_cast<T>(patch.u0),
          static_cast<T>(patch.u1),
          static_cast<T>(patch.v0),
          static_cast<T>(patch.v1),
          static_cast<T>(magnitude)};
}

// Lengths of the derivatives of a patch's control points: means of the first, largest of the second.
struct Bending {
  double u = 0, v = 0, uu = 0, uv = 0, vv = 0;

  explicit Bending(const BezierPatch& patch) {
    const std::size_t row = patch.degrees.row(), rows = patch.degrees.rows();
    const auto at = [&](std::size_t i, std::size_t j) { return patch.point(j * row + i); };
    const double m = patch.degrees.u, n = patch.degrees.v;
    for (std::size_t j = 0; j < rows; ++j)
      for (std::size_t i = 0; i < row; ++i) {
        if (i + 1 < row) u += length(at(i + 1, j) - at(i, j)) / static_cast<double>(rows);
        if (j + 1 < rows) v += length(at(i, j + 1) - at(i, j)) / static_cast<double>(row);
        if (i + 2 < row)
          uu = std::max(uu, m * (m - 1) * length(at(i + 2, j) - at(i + 1, j) * 2.0 + at(i, j)));
        if (j + 2 < rows)
          vv = std::max(vv, n * (n - 1) * length(at(i, j + 2) - at(i, j + 1) * 2.0 + at(i, j)));
        if (i + 1 < row && j + 1 < rows)
          uv = std::max(uv, m * n * length(at(i + 1, j + 1) - at(i + 1, j) - at(i, j + 1) + at(i, j)));
      }
  }
};

enum class Cut { none, u, v };

// Returns half of the largest side of the control points' box.
double half_size(const BezierPatch& patch) {
  const Boundsd box = local_box_of(patch);
  return max_component(box.hi - box.lo) / 2;
}

// Returns how to halve the patch so that its derivatives change by less than a half, about 29 degrees of a
// circle, and its half size is at most a quarter of `magnitude`. Most rays that are not grazing then need one
// Newton iteration for each piece, and the tolerance of hits is less than the offset of rays that leave the
// surface (SurfaceBatch::step).
Cut cut_of(const BezierPatch& patch, double magnitude) {
  constexpr double kMaxChange = 0.5;
  const Bending bending(patch);
  if (bending.uu > kMaxChange * bending.u && bending.uu * bending.v >= bending.vv * bending.u) return Cut::u;
  if (bending.vv > kMaxChange * bending.v) return Cut::v;
  const bool large = half_size(patch) > magnitude / 4;
  if (large || bending.uv > kMaxChange * std::max(bending.u, bending.v))
    return bending.u > bending.v ? Cut::u : Cut::v;
  return Cut::none;
}

// Returns the second half of the patch, and replaces the patch by the first.
BezierPatch split_off(BezierPatch& patch, bool along_u) {
  BezierPatch second = patch;
  for (std::size_t channel = 0; channel < 4; ++channel)
    split_net(patch.net.data() + channel * patch.size(), second.net.data() + channel * patch.size(),
              patch.degrees, along_u);
  if (along_u)
    patch.u1 = second.u0 = (patch.u0 + patch.u1) / 2;
  else
    patch.v1 = second.v0 = (patch.v0 + patch.v1) / 2;
  return second;
}

// Upper bounds of the second derivatives of a patch, in metres per parameter squared. From the derivatives of
// x w, y w, z w and w, relative to the centre of the control points.
struct SecondDerivatives {
  double uu = 0, uv = 0, vv = 0;

  explicit SecondDerivatives(const BezierPatch& patch) {
    const std::size_t row = patch.degrees.row(), rows = patch.degrees.rows(), size = patch.size();
    const double m = patch.degrees.u, n = patch.degrees.v;
    const auto point = [&](std::size_t i, std::size_t j) {
      const double* const net = &patch.net[j * row + i];
      return Vec3d(net[0], net[size], net[2 * size]);
    };
    const auto weight = [&](std::size_t i, std::size_t j) { return patch.weight(j * row + i); };
    struct Largest {
      double point = 0, weight = 0;
      void add(double factor, const Vec3d& p, double w) {
        point = std::max(point, factor * length(p));
        weight = std::max(weight, factor * std::abs(w));
      }
    } u, v, u2, uv2, v2;
    double reach = 0, least = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < rows; ++j)
      for (std::size_t i = 0; i < row; ++i) {
        const auto difference = [&](const auto& at, std::size_t k, std::size_t l) {
          return at(i + k, j + l) - at(i, j);
        };
        const auto second = [&](const auto& at, std::size_t k, std::size_t l, std::size_t o, std::size_t p) {
          return at(i + k + o, j + l + p) - at(i + k, j + l) - (at(i + o, j + p) - at(i, j));
        };
        reach = std::max(reach, length(patch.point(j * row + i)));
        least = std::min(least, weight(i, j));
        if (i + 1 < row) u.add(m, difference(point, 1, 0), difference(weight, 1, 0));
        if (j + 1 < rows) v.add(n, difference(point, 0, 1), difference(weight, 0, 1));
        if (i + 2 < row) u2.add(m * (m - 1), second(point, 1, 0, 1, 0), second(weight, 1, 0, 1, 0));
        if (j + 2 < rows) v2.add(n * (n - 1), second(point, 0, 1, 0, 1), second(weight, 0, 1, 0, 1));
        if (i + 1 < row && j + 1 < rows)
          uv2.add(m * n, second(point, 1, 0, 0, 1), second(weight, 1, 0, 0, 1));
      }
    // With S = X / w: S_u = (X_u - S w_u) / w, S_uv = (X_uv - S_u w_v - S_v w_u - S w_uv) / w.
    const double su = (u.point + reach * u.weight) / least, sv = (v.point + reach * v.weight) / least;
    uu = (u2.point + 2 * su * u.weight + reach * u2.weight) / least;
    vv = (v2.point + 2 * sv * v.weight + reach * v2.weight) / least;
    uv = (uv2.point + su * v.weight + sv * u.weight + reach * uv2.weight) / least;
  }
};

// Adds a grid of us * vs quads on the patch.
void add_grid(const BezierPatch& patch, int us, int vs, int primitive, Tessellation& out) {
  const BezierPiece<double> piece = piece_of<double>(patch, 0, 0);
  const auto first = static_cast<std::uint32_t>(out.vertices.size());
  for (int j = 0; j <= vs; ++j)
    for (int i = 0; i <= us; ++i) {
      checkpoint(out.vertices.size());
      const double u = double(i) / us, v = double(j) / vs;
      const auto point = bezier_point<double>(piece, patch.net.data(), u, v);
      out.add(patch.origin + point.position, bezier_normal<double>(piece, patch.net.data(), u, v, point));
    }
  const auto row = static_cast<std::uint32_t>(us) + 1;
  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(vs); ++j)
    for (std::uint32_t i = 0; i + 1 < row; ++i) {
      const std::uint32_t a = first + j * row + i;
      out.add_quad(primitive, a, a + 1, a + row + 1, a + row);
    }
}

}  // namespace

BezierPatch centered(BezierPatch patch) {
  const Boundsd box = local_box_of(patch);
  const Vec3d shift = (box.lo + box.hi) * 0.5;
  double largest = 0;
  for (std::size_t i = 0; i < patch.size(); ++i) largest = std::max(largest, patch.weight(i));
  int exponent = 0;
  std::frexp(largest, &exponent);  // weights become 1/2 to 1, without rounding
  const double scale = patch.rational ? std::ldexp(1.0, -exponent) : 1.0;
  for (std::size_t i = 0; i < patch.size(); ++i) {
    const double w = patch.weight(i);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double& x = patch.net[axis * patch.size() + i];
      x = (x - shift[axis] * w) * scale;
    }
    patch.net[3 * patch.size() + i] = w * scale;
  }
  patch.origin = patch.origin + shift;
  return patch;
}

int BezierSet::add(Params& params, MeshSource&) {
  Object object{{}, pieces_.size(), 0};
  read_(params, object.patches);
  for (BezierPatch& patch : object.patches) {
    patch = centered(std::move(patch));
    object.magnitude = std::max(object.magnitude, box_of(patch).magnitude());
  }
  for (const BezierPatch& patch : object.patches)
    if (!add_pieces(patch, object.magnitude)) {
      params.fail("", "pieces of the curved patches of the scene need more than " +
                          grouped(kMaxBezierCoefficients) + " coefficients");
      return 0;
    }
  objects_.push_back(std::move(object));
  return static_cast<int>(pieces_.size() - objects_.back().first_piece);
}

bool BezierSet::add_pieces(const BezierPatch& patch, double magnitude) {
  constexpr int kMaxCuts = 10;  // limit for one patch, in sequence
  struct Part {
    BezierPatch patch;
    int cuts;
  };
  std::vector<Part> parts;
  parts.push_back({patch, 0});
  while (!parts.empty()) {
    checkpoint();
    Part& part = parts.back();
    const Cut cut = part.cuts < kMaxCuts ? cut_of(part.patch, magnitude) : Cut::none;
    if (cut != Cut::none) {
      const int cuts = ++part.cuts;
      BezierPatch second = split_off(part.patch, cut == Cut::u);
      parts.push_back({std::move(second), cuts});
      continue;
    }
    coefficients_ += part.patch.net.size();
    if (coefficients_ > kMaxBezierCoefficients) return false;
    pieces_.push_back(centered(std::move(part.patch)));
    parts.pop_back();
  }
  return true;
}

Boundsd BezierSet::bounds(int index) const { return box_of(pieces_[static_cast<std::size_t>(index)]); }

// All patches of an object have the same number of quads, so that triangles of neighbours share their
// vertices. A flat triangle of a patch of du by dv is within (|S_uu| du^2 + 2 |S_uv| du dv + |S_vv| dv^2) / 8
// of the surface S (Filip, Magedson and Markot, "Surface algorithms using bounds on derivatives", 1986), and
// 2 du dv <= du^2 + dv^2.
void BezierSet::tessellate(const TessellationView& view, int first, Tessellation& out) const {
  for (const Object& object : objects_) {
    Boundsd box;
    double us = 0, vs = 0;  // largest |S_uu| + |S_uv| and |S_vv| + |S_uv|
    for (const BezierPatch& patch : object.patches) {
      checkpoint();
      box.include(box_of(patch));
      const SecondDerivatives bound(patch);
      us = std::max(us, bound.uu + bound.uv);
      vs = std::max(vs, bound.vv + bound.uv);
    }
    const Vec3d outside = largest(largest(box.lo - view.eye, view.eye - box.hi), Vec3d(0));
    const double pixel = view.pixel_at(length(outside));
    const auto count = [&](double bend) {
      const double least = std::sqrt(bend / (4 * view.max_error * pixel));
      return std::max(1, static_cast<int>(std::ceil(std::min(least, double{Tessellation::kMaxSides}))));
    };
    const int columns = count(us), rows = count(vs);
    const double error = us / (double(columns) * columns) + vs / (double(rows) * rows);
    if (error > 0) out.error = std::max(out.error, error / (8 * pixel));
    for (const BezierPatch& patch : object.patches)
      add_grid(patch, columns, rows, first + static_cast<int>(object.first_piece), out);
  }
}

template <class T>
ShapeKernelPtr<T> BezierSet::make(int first) const {
  auto table = std::make_shared<BezierTable<T>>();
  table->pieces.reserve(pieces_.size());
  for (std::size_t k = 0; k < objects_.size(); ++k) {
    const std::size_t end = k + 1 < objects_.size() ? objects_[k + 1].first_piece : pieces_.size();
    for (std::size_t i = objects_[k].first_piece; i < end; ++i) {
      checkpoint(i);
      const BezierPatch& patch = pieces_[i];
      table->pieces.push_back(piece_of<T>(patch, table->nets.size(), objects_[k].magnitude));
      // The origin is rounded first. The control points are relative to the rounded origin.
      const Vec3d shift = patch.origin - Vec3d(Vec3<T>(patch.origin));
      for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t j = 0; j < patch.size(); ++j)
          table->nets.push_back(
              static_cast<T>(patch.net[axis * patch.size() + j] + shift[axis] * patch.weight(j)));
      if (patch.rational)
        for (std::size_t j = 0; j < patch.size(); ++j) table->nets.push_back(static_cast<T>(patch.weight(j)));
    }
  }
  return std::make_shared<BezierKernel<T>>(std::move(table), first);
}

}  // namespace orrery
