#include "core/accelerators/moving_instances.h"

#include <cmath>
#include <numbers>

namespace orrery {
namespace {

constexpr int kMaxPieces = 64;       // maximum pieces per motion segment
constexpr double kPieceDegrees = 4;  // maximum rotation per piece, unless kMaxPieces is exceeded

// Extends the box by the path of a model point between two placements. The point rotates about a unit axis by
// `turn` radians while its scaled position v moves linearly, for time from 0 to 1. The second derivative of
// the path is at most |turn|^2 |v| + 2 |turn| |v'|. The path deviates from its chord by at most an eighth of
// this bound.
void include_path(const Vec3d& axis, const Placement& from, const Placement& to, const Vec3d& point,
                  Boundsd& box) {
  const auto at = [&](const Placement& p) {
    return rotation(axis, p.degrees).vector(point * p.scale) + p.translate;
  };
  const double turn = std::abs(to.degrees - from.degrees) * (std::numbers::pi / 180);
  const double reach = std::max(length(point * from.scale), length(point * to.scale));
  const double off = turn * (turn * reach + 2 * length(point * (to.scale - from.scale))) / 8;
  const Vec3d pad(std::min(off, 2 * reach));  // the rotating part stays within `reach` of the origin
  for (const Vec3d& end : {at(from), at(to)}) {
    box.include(end - pad);
    box.include(end + pad);
  }
}

// Returns the ratio of the largest to the smallest scale factor.
double condition_of(const Vec3d& scale) {
  const Vec3d size = abs(scale);
  return max_component(size) / std::min({size.x, size.y, size.z});
}

}  // namespace

Boundsd bounds_during(const Boundsd& model, const Instance& instance, const Exposure& exposure) {
  if (!model.bounded()) return Boundsd::everything();
  const std::vector<double> moments = instance.motion.moments(exposure);
  Boundsd box;
  double condition = 1;
  for (std::size_t k = 0; k + 1 < moments.size(); ++k) {
    const Placement from = instance.motion.at(moments[k]), to = instance.motion.at(moments[k + 1]);
    const double turned = std::abs(to.degrees - from.degrees);
    const int pieces =
        static_cast<int>(std::clamp(std::ceil(turned / kPieceDegrees), 1.0, double{kMaxPieces}));
    for (int piece = 0; piece < pieces; ++piece) {
      const Placement start = mix(from, to, static_cast<double>(piece) / pieces),
                      end = mix(from, to, static_cast<double>(piece + 1) / pieces);
      for (const Vec3d& corner : corners_of(model)) include_path(instance.axis, start, end, corner, box);
    }
    condition = std::max({condition, condition_of(from.scale), condition_of(to.scale)});
  }
  const Vec3d pad(32 * double{std::numeric_limits<float>::epsilon()} * condition * box.magnitude());
  box.lo = box.lo - pad;
  box.hi = box.hi + pad;
  return box;
}

template <class T>
MovingInstance<T>::MovingInstance(const Instance& instance, std::shared_ptr<const ModelGeometry<T>> of,
                                  int number, const Exposure& exposure)
    : model(std::move(of)),
      first(number),
      last(number + static_cast<int>(model->primitives.size())),
      segments(instance.motion.moments(exposure)) {
  const std::vector<double> times = instance.motion.moments(exposure);
  double max_scale = 0, max_translate = 0;
  for (std::size_t k = 0; k + 1 < times.size(); ++k) {
    const Placement from = instance.motion.at(times[k]), to = instance.motion.at(times[k + 1]);
    const Affined turn = rotation(instance.axis, from.degrees);
    Moment& moment = moments.emplace_back();
    const std::array<Vec3d, 3> axes{turn.x, turn.y, turn.z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Vec3d along = instance.axis * dot(instance.axis, axes[axis]);
      moment.along[axis] = Vec3<T>(along);
      moment.across[axis] = Vec3<T>(axes[axis] - along);
      moment.beyond[axis] = Vec3<T>(cross(instance.axis, axes[axis]));
    }
    moment.turns = static_cast<T>((to.degrees - from.degrees) / 360);
    moment.scale = Vec3<T>(from.scale);
    moment.more_scale = Vec3<T>(to.scale - from.scale);
    moment.translate = Vec3<T>(from.translate);
    moment.more_translate = Vec3<T>(to.translate - from.translate);
    for (const Placement& placement : {from, to}) {
      max_scale = std::max(max_scale, max_component(abs(placement.scale)));
      max_translate = std::max(max_translate, max_component(abs(placement.translate)));
    }
  }
  // Twice the step of static instances, because the rotation is rounded once more. The factor 2 > sqrt(3)
  // bounds how much a rotation enlarges the largest coordinate.
  step_scale = static_cast<T>(8 * max_scale);
  step_base = static_cast<T>(32 * double{std::numeric_limits<T>::epsilon()} * max_translate);
}

template struct MovingInstance<float>;
template struct MovingInstance<double>;

}  // namespace orrery
