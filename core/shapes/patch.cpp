#include "core/base/shorten.h"
#include "core/params/params.h"
#include "core/shapes/bezier_set.h"
#include "core/shapes/control_points.h"

namespace orrery {
namespace {

void read_patches(Params& p, std::vector<BezierPatch>& out) {
  const NetDegrees degrees = read_degrees(p, 3);
  const std::size_t size = degrees.size();
  const ControlPoints control = read_control_points(
      p,
      "Control points, in metres, of one patch after another. In a patch, u rises from point to point and v "
      "from row to row.");
  if (control.points.size() % size != 0) {
    p.fail("points", "must be a list of a multiple of " + std::to_string(size) +
                         " entries, (degree_u + 1) * (degree_v + 1) per patch (got " +
                         std::to_string(control.points.size()) + ")");
    return;
  }
  for (std::size_t first = 0; first + size <= control.points.size(); first += size) {
    BezierPatch patch{degrees, control.rational, control.origin, std::vector<double>(4 * size), 0, 1, 0, 1};
    for (std::size_t i = 0; i < size; ++i) control.put(first + i, patch.net, i, size);
    out.push_back(std::move(patch));
  }
}

std::unique_ptr<ShapeSet> make_patch_set() { return std::make_unique<BezierSet>(read_patches); }

}  // namespace

ShapeType patch_type() { return {"patch", "One or more Bezier patches.", make_patch_set}; }

}  // namespace orrery
