#include "core/meshes/gltf_animation.h"

#include <algorithm>
#include <cmath>

#include "core/base/task_scope.h"
#include "core/math/elementary.h"
#include "core/meshes/formats.h"
#include "core/meshes/text.h"

namespace orrery {
namespace {

using Values = std::vector<double>;

enum class Interpolation { step, linear, cubic };

Interpolation interpolation_of(const GltfValue& sampler) {
  const auto name = sampler.find("interpolation");
  if (!name || name->text() == "LINEAR") return Interpolation::linear;
  if (name->text() == "STEP") return Interpolation::step;
  if (name->text() == "CUBICSPLINE") return Interpolation::cubic;
  name->fail("must be LINEAR, STEP or CUBICSPLINE (got " + excerpt(name->text()) + ")");
}

// Position of a time among the keyframes: `fraction` of the way from keyframe `key` to the next one, which is
// `seconds` later.
struct Moment {
  std::size_t key;
  double fraction, seconds;
};

Moment find_moment(const GltfNumbers& times, double time, const GltfValue& place) {
  std::size_t key = 0;
  for (std::size_t i = 0; i < times.count; ++i) {
    checkpoint(i);
    const double at = times.value(i, 0);
    if (!std::isfinite(at) || (i > 0 && at < times.value(i - 1, 0)))
      place.fail("times must be ascending (got " + text_of(at) + " at keyframe " + std::to_string(i) + ")");
    if (at <= time) key = i;
  }
  const double start = times.value(key, 0);
  if (key + 1 == times.count || time <= start) return {key, 0, 0};
  const double seconds = times.value(key + 1, 0) - start;
  return {key, (time - start) / seconds, seconds};
}

// Spherical linear interpolation of unit quaternions, the shorter way (appendix C.3).
Values slerp(const Values& from, const Values& to, double fraction) {
  double cosine = 0;
  for (std::size_t i = 0; i < 4; ++i) cosine += from[i] * to[i];
  const double sign = cosine < 0 ? -1 : 1;
  cosine = std::min(std::abs(cosine), 1.0);
  constexpr double kParallel = 1 - 1e-9;  // the weights are linear to this relative accuracy
  double before = 1 - fraction, after = fraction;
  if (cosine < kParallel) {
    const double sine = std::sqrt((1 - cosine) * (1 + cosine)), angle = direction_turns(cosine, sine) * 360;
    before = sine_cosine_degrees(angle * (1 - fraction)).sine / sine;
    after = sine_cosine_degrees(angle * fraction).sine / sine;
  }
  Values between(4);
  for (std::size_t i = 0; i < 4; ++i) between[i] = from[i] * before + to[i] * (sign * after);
  return between;
}

void normalize_quaternion(Values& q) {
  double square = 0;
  for (const double part : q) square += part * part;
  if (!(square > 0) || !std::isfinite(square)) return;  // rejected by transform_of()
  for (double& part : q) part /= std::sqrt(square);
}

// Cubic Hermite spline (appendix C.5). `tangent_from` and `tangent_to` are per second.
Values hermite(const Values& from, const Values& tangent_from, const Values& to, const Values& tangent_to,
               const Moment& moment) {
  const double t = moment.fraction, t2 = t * t, t3 = t2 * t;
  Values between(from.size());
  for (std::size_t i = 0; i < from.size(); ++i)
    between[i] = (2 * t3 - 3 * t2 + 1) * from[i] + moment.seconds * (t3 - 2 * t2 + t) * tangent_from[i] +
                 (3 * t2 - 2 * t3) * to[i] + moment.seconds * (t3 - t2) * tangent_to[i];
  return between;
}

class Sampler {
 public:
  // `type`: of the output, SCALAR for weights.
  Sampler(GltfFile& file, const GltfValue& sampler, const char* type)
      : interpolation_(interpolation_of(sampler)),
        input_(sampler.at("input")),
        times_(file.accessor(input_, "SCALAR")),
        output_(file.accessor(sampler.at("output"), type)),
        parts_(times_.count * (interpolation_ == Interpolation::cubic ? 3 : 1)) {
    const bool is_list = output_.components == 1;
    if (is_list ? output_.count % parts_ != 0 : output_.count != parts_)
      sampler.at("output").fail("must have " + std::to_string(parts_) + (is_list ? " n" : "") +
                                " elements (got " + std::to_string(output_.count) + ")");
    width_ = is_list ? output_.count / parts_ : output_.components;
  }

  Values at(double time, bool is_rotation) const {
    const Moment moment = find_moment(times_, time, input_);
    if (interpolation_ == Interpolation::cubic) return cubic_at(moment, is_rotation);
    Values from = part(moment.key);
    if (is_rotation) normalize_quaternion(from);
    if (interpolation_ == Interpolation::step || moment.fraction == 0) return from;
    Values to = part(moment.key + 1);
    if (is_rotation) normalize_quaternion(to);
    if (is_rotation) return slerp(from, to, moment.fraction);
    for (std::size_t i = 0; i < width_; ++i)
      from[i] = from[i] * (1 - moment.fraction) + to[i] * moment.fraction;
    return from;
  }

 private:
  // A keyframe of a spline has three parts: tangent before it, value, tangent after it.
  Values cubic_at(const Moment& moment, bool is_rotation) const {
    const std::size_t first = 3 * moment.key;
    Values value = part(first + 1);
    if (moment.fraction > 0)
      value = hermite(value, part(first + 2), part(first + 4), part(first + 3), moment);
    if (is_rotation) normalize_quaternion(value);
    return value;
  }

  Values part(std::size_t i) const {
    Values values(width_);
    for (std::size_t k = 0; k < width_; ++k)
      values[k] = output_.components == 1 ? output_.value(i * width_ + k, 0) : output_.value(i, k);
    return values;
  }

  Interpolation interpolation_;
  GltfValue input_;
  GltfNumbers times_, output_;
  std::size_t parts_, width_ = 0;
};

void read_channel(GltfFile& file, const GltfValue& animation, const GltfValue& channel, double time,
                  GltfPose& pose) {
  const GltfValue target = channel.at("target"), path = target.at("path");
  const auto node = target.find("node");
  if (!node || path.text() == "pointer") return;  // the target of an extension
  const auto values = [&](const char* type, bool is_rotation = false) {
    const GltfValue sampler = animation.at("samplers").item(channel.at("sampler").integer());
    return Sampler(file, sampler, type).at(time, is_rotation);
  };
  const auto three = [&] {
    const Values v = values("VEC3");
    return Vec3d(v[0], v[1], v[2]);
  };
  NodePose& changed = pose[node->integer()];
  if (path.text() == "translation") {
    changed.translation = three();
  } else if (path.text() == "scale") {
    changed.scale = three();
  } else if (path.text() == "rotation") {
    const Values q = values("VEC4", true);
    changed.rotation = {q[0], q[1], q[2], q[3]};
  } else if (path.text() == "weights") {
    changed.weights = values("SCALAR");
  } else {
    path.fail("must be translation, rotation, scale or weights (got " + excerpt(path.text()) + ")");
  }
}

// Returns the largest time of the keyframes, which accessors of times state as their maximum, or 0 if an
// accessor is invalid.
double duration_of(const GltfFile& file, const GltfValue& animation) {
  double seconds = 0;
  try {
    const GltfValue samplers = animation.at("samplers"), accessors = file.root().at("accessors");
    for (std::size_t i = 0; i < samplers.size(); ++i) {
      const double last = accessors.item(samplers.item(i).at("input").integer()).at("max").item(0).number();
      if (std::isfinite(last)) seconds = std::max(seconds, last);
    }
  } catch (const InputError&) {
    return 0;
  }
  return seconds;
}

}  // namespace

GltfPose read_pose(GltfFile& file, const ModelPose& pose) {
  const auto animations = file.root().find("animations");
  if (!animations || animations->size() == 0)
    throw InputError("", "must be a model with animations to have a pose at a time (got none)");
  const GltfValue animation = animations->item(static_cast<std::size_t>(pose.animation)),
                  channels = animation.at("channels");
  GltfPose found;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    checkpoint();
    read_channel(file, animation, channels.item(i), pose.time, found);
  }
  return found;
}

std::vector<ModelAnimation> list_animations(const GltfFile& file) {
  std::vector<ModelAnimation> found;
  const auto animations = file.root().find("animations");
  for (std::size_t i = 0; animations && i < animations->size(); ++i) {
    checkpoint();
    const GltfValue animation = animations->item(i);
    const auto name = animation.find("name");
    found.push_back({name ? name->text() : "", duration_of(file, animation)});
  }
  return found;
}

}  // namespace orrery
