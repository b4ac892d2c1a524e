#include "core/load/mirror_paths.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/task_scope.h"
#include "core/math/hemisphere.h"
#include "core/math/mirror.h"
#include "core/model/object_pointer.h"

namespace orrery {
namespace {

// Multiples of the largest coordinate: least distance of a hit, and distance of the neighbouring ray.
constexpr double kLeast = 1e-13, kShift = 1e-8;
constexpr int kSides = 4;

}  // namespace

MirrorPaths::MirrorPaths(const Scene& scene, const PlacedPrimitives& primitives, double magnitude)
    : scene_(scene),
      primitives_(primitives),
      least_(kLeast * magnitude),
      shift_(kShift * magnitude),
      error_(kRoundingsOfHit * double{std::numeric_limits<float>::epsilon()} * magnitude) {}

void MirrorPaths::trace(int stride) {
  const auto& all = primitives_.all();
  if (std::none_of(all.begin(), all.end(), [&](const auto& p) { return primitives_.mirrored_share(p) > 0; }))
    return;
  for (int view = 0; view < kSides; ++view)
    trace_view(frame_at(scene_.placement, *scene_.camera, {.azimuth_degrees = 360.0 * view / kSides}),
               stride);
}

void MirrorPaths::trace_view(const CameraFrame& frame, int stride) {
  const auto rays = std::make_unique<RayBatch<double>>();
  scene_.camera->generate(frame, kTileSide, kTileSide, TileView{0, 0, kTileSide, kTileSide},
                          TileSamples::centres(), *rays);
  Squares squares{};
  int traced = 0;
  for (int i = 0; i < kBatch; i += stride, ++traced) {
    checkpoint();
    follow((*rays)[i], squares);
  }
  for (std::size_t depth = 1; depth < squares.size(); ++depth) {
    double& turn = turns_.after[depth - 1];
    turn = std::max(turn, std::sqrt(squares[depth] / traced));
  }
}

std::optional<MirrorPaths::Hit> MirrorPaths::nearest(const Ray<double>& ray) {
  std::optional<Hit> found;
  const BoxRay<double> box_ray(ray.origin, ray.direction);
  for (const PlacedPrimitive& placed : primitives_.all()) {
    if (!may_meet(placed.box, box_ray)) continue;
    const auto hit = tester_.intersect(placed, ray);
    if (hit && hit->distance > least_ && (!found || hit->distance < found->at.distance))
      found = Hit{&placed, *hit};
  }
  return found;
}

// Follows a ray and its neighbour along mirrors. Both keep a distance of shift_ in the space of positions and
// directions, so that errors of any growth are measured in double precision (Benettin et al. 1980). Adds the
// squares of the largest turns up to each depth. The path ends where the neighbour misses the primitive.
void MirrorPaths::follow(const Ray<double>& from, Squares& squares) {
  Ray<double> ray = from, neighbour{from.origin + tangents_of(from.direction).first * shift_, from.direction};
  double growth = 1, weight = 1, largest = 0;  // growth: error of the path / distance of both rays
  std::size_t depth = 1;
  for (; depth < squares.size(); ++depth) {
    const auto hit = nearest(ray);
    if (!hit) break;
    weight *= primitives_.mirrored_share(*hit->primitive);
    if (weight == 0) break;
    const auto nearby = tester_.intersect(*hit->primitive, neighbour);
    if (!nearby) break;
    const Vec3d onward = safe_normalize(mirrored(ray.direction, hit->at.shading));
    const Vec3d turn = safe_normalize(mirrored(neighbour.direction, nearby->shading)) - onward;
    const Vec3d apart = nearby->position - hit->at.position;
    const double radians = weight * std::min(1.0, growth * error_ / shift_ * length(turn));
    if (radians > largest) {
      largest = radians;
      if (largest > turns_.largest) {
        turns_.largest = largest;
        turns_.where = pointer_to_object(scene_, hit->primitive->number);
      }
    }
    squares[depth] += largest * largest;
    const double distance = std::max(length(apart), hit->at.distance * length(turn));
    if (distance == 0) break;
    growth *= distance / shift_;
    const Vec3d start = hit->at.position + hit->at.outward * (2 * least_);
    ray = {start, onward};
    neighbour = {start + apart * (shift_ / distance), safe_normalize(onward + turn * (shift_ / distance))};
  }
  for (; depth < squares.size(); ++depth) squares[depth] += largest * largest;
}

}  // namespace orrery
