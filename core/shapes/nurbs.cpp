#include "core/params/params.h"
#include "core/shapes/bezier_set.h"
#include "core/shapes/control_points.h"

namespace orrery {
namespace {

constexpr std::size_t kMaxKnots = 65'536;

// Knots of one direction.
struct Knots {
  std::vector<double> at;
  int degree;

  std::size_t points() const { return at.size() - static_cast<std::size_t>(degree) - 1; }
  double first() const { return at[static_cast<std::size_t>(degree)]; }
  double last() const { return at[points()]; }
  // Returns the position of a knot in the domain, 0 to 1.
  double part(std::size_t i) const { return (at[i] - first()) / (last() - first()); }
  // Returns the spans [at[i], at[i + 1]] of the domain that are not empty.
  std::vector<std::size_t> spans() const {
    std::vector<std::size_t> all;
    for (std::size_t i = static_cast<std::size_t>(degree); i < points(); ++i)
      if (at[i] < at[i + 1]) all.push_back(i);
    return all;
  }
};

// Reads knots. Records a problem and returns no knots if they do not define a curve of the degree.
Knots read_knots(Params& p, std::string_view key, std::string_view doc, int degree) {
  Knots knots{p.numbers(key, doc, {4, kMaxKnots}, {.min = -kMaxCoordinate, .max = kMaxCoordinate}), degree};
  const auto width = static_cast<std::size_t>(degree) + 1;
  const auto reject = [&](const std::string& detail) {
    p.fail(key, detail);
    return Knots{{}, degree};
  };
  if (knots.at.size() < 2 * width)
    return reject("must be a list of at least " + std::to_string(2 * width) +
                  " entries, 2 * (degree + 1) (got " + std::to_string(knots.at.size()) + ")");
  for (std::size_t i = 0; i + 1 < knots.at.size(); ++i)
    if (knots.at[i + 1] < knots.at[i])
      return reject("must not fall (got " + number_text(knots.at[i + 1]) + " after " +
                    number_text(knots.at[i]) + ")");
  if (!(knots.first() < knots.last())) return reject("must rise between the end knots");
  for (std::size_t i = 1; i + width < knots.at.size(); ++i)
    if (knots.at[i] == knots.at[i + width - 1] && knots.at[i] > knots.first() && knots.at[i] < knots.last())
      return reject("must not repeat an inner knot more often than the degree (got " +
                    number_text(knots.at[i]) + " at least " + std::to_string(width) + " times)");
  return knots;
}

// Replaces the coefficients of the B-splines of a span by the coefficients of Bernstein polynomials on the
// span, by the blossom of the span's polynomial: de Boor's algorithm with one of the ends as each argument
// (Ramshaw, "Blossoms are polar forms", 1989). The result is that of knot insertion. `at(k)` is the reference
// to coefficient k of the span, 0 to degree.
template <class At>
void to_bezier(const Knots& knots, std::size_t span, const At& at) {
  const auto degree = static_cast<std::size_t>(knots.degree);
  std::array<double, kMaxBezierDegree + 1> bezier, row;
  for (std::size_t j = 0; j <= degree; ++j) {
    for (std::size_t k = 0; k <= degree; ++k) row[k] = at(k);
    for (std::size_t r = 1; r <= degree; ++r) {
      const double argument = knots.at[r <= j ? span + 1 : span];
      for (std::size_t k = degree; k >= r; --k) {
        const double low = knots.at[span - degree + k], high = knots.at[span + k + 1 - r];
        const double part = (argument - low) / (high - low);
        row[k] = row[k - 1] * (1 - part) + row[k] * part;
      }
    }
    bezier[j] = row[degree];
  }
  for (std::size_t j = 0; j <= degree; ++j) at(j) = bezier[j];
}

void read_nurbs(Params& p, std::vector<BezierPatch>& out) {
  const NetDegrees degrees = read_degrees(p);
  const Knots us = read_knots(p, "knots_u", "Knots along u, in ascending order.", degrees.u);
  const Knots vs = read_knots(p, "knots_v", "Knots along v, in ascending order.", degrees.v);
  const ControlPoints control = read_control_points(
      p,
      "Control points, in metres: knots - degree - 1 along each direction. u rises from point to point and "
      "v from row to row.");
  if (us.at.empty() || vs.at.empty()) return;
  const std::size_t columns = us.points(), rows = vs.points();
  if (control.points.size() != columns * rows) {
    p.fail("points", "must be a list of " + std::to_string(columns * rows) + " entries, " +
                         std::to_string(columns) + " along u and " + std::to_string(rows) + " along v (got " +
                         std::to_string(control.points.size()) + ")");
    return;
  }
  const std::size_t size = degrees.size(), row = degrees.row();
  for (const std::size_t v : vs.spans())
    for (const std::size_t u : us.spans()) {
      BezierPatch patch{degrees,    control.rational, control.origin, std::vector<double>(4 * size),
                        us.part(u), us.part(u + 1),   vs.part(v),     vs.part(v + 1)};
      for (std::size_t i = 0; i < size; ++i)
        control.put((v - vs.degree + i / row) * columns + (u - us.degree + i % row), patch.net, i, size);
      for (std::size_t line = 0; line < 4 * degrees.rows(); ++line)
        to_bezier(us, u, [&](std::size_t k) -> double& { return patch.net[line * row + k]; });
      for (std::size_t channel = 0; channel < 4; ++channel)
        for (std::size_t i = 0; i < row; ++i)
          to_bezier(vs, v, [&](std::size_t k) -> double& { return patch.net[channel * size + k * row + i]; });
      out.push_back(std::move(patch));
    }
}

std::unique_ptr<ShapeSet> make_nurbs_set() { return std::make_unique<BezierSet>(read_nurbs); }

}  // namespace

ShapeType nurbs_type() { return {"nurbs", "A surface of rational B-splines (NURBS).", make_nurbs_set}; }

}  // namespace orrery
