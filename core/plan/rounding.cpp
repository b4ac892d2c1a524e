#include "core/plan/rounding.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/model/technique.h"
#include "core/params/params.h"

namespace orrery {
namespace {

constexpr double kMaxOfLength = 0.1;      // allowed error of a hit / smallest visible length
constexpr double kMaxTurn = 0.02;         // allowed error of a mirrored ray's direction, radians
constexpr double kMaxTurnOfPaths = 0.04;  // allowed MirrorTurns::after, radians
// Minimum size of features in metres for float. The cube of a hundredth of this length is still a normal
// float.
constexpr double kMinLengthInFloat = 1e-10;

std::string metres(double x) { return number_text(x) + " m"; }

class Limits {
 public:
  Limits(const Scene& scene, const Plan& plan)
      : scene_(scene),
        facts_(scene.facts),
        plan_(plan),
        measured_(std::max(scene.facts.magnitude.value, max_component(abs(scene.placement.eye)))),
        magnitude_(facts_.magnitude) {
    const double eye = max_component(abs(plan.frame.eye));
    if (eye > magnitude_.value) magnitude_ = {eye, "/camera/eye"};
  }

  RoundingLimit strictest() {
    take(facts_.rounding);
    take_length(facts_.smallest_feature.value, facts_.smallest_feature.where + " has features as small as " +
                                                   metres(facts_.smallest_feature.value));
    take_length(facts_.layer_distance.value, "a surface of " + facts_.layer_distance.where + " is " +
                                                 metres(facts_.layer_distance.value) +
                                                 " from the nearest other surface");
    const double pixel = footprint();
    take_length(pixel, "a pixel is " + metres(pixel) + " wide at the nearest object");
    take_mirrors();
    take_mean_free_path();
    take_turns();
    if (facts_.smallest_feature.value < kMinLengthInFloat)
      take({0, facts_.smallest_feature.where + " has features as small as " +
                   metres(facts_.smallest_feature.value) + ": products of such lengths underflow in float"});
    return strictest_;
  }

 private:
  void take(const RoundingLimit& limit) {
    if (limit.epsilon < strictest_.epsilon) strictest_ = limit;
  }
  void take_length(double length, const std::string& what) {
    take({kMaxOfLength * length / (kRoundingsOfHit * magnitude_.value),
          what + ", with coordinates up to " + metres(magnitude_.value) + " (" + magnitude_.where + ")"});
  }

  // Returns the width of a pixel in metres at the bounding box of the scene, or at look_at if that is nearer.
  // The distance to the box counts as at least 1/16 of its diagonal, because the eye may be inside. Parallel
  // cameras have the same pixel width at any distance.
  double footprint() const {
    const double pixel = 2 * plan_.frame.half_extent / plan_.height;
    if (plan_.camera->parallel()) return pixel;
    return pixel * std::min(plan_.frame.distance, nearest());
  }
  double nearest() const {
    const Boundsd& box = facts_.bounds;
    if (!box.bounded()) return plan_.frame.distance;
    const Vec3d &eye = plan_.frame.eye, below = box.lo - eye, above = eye - box.hi;
    const auto beyond = [](double lo, double hi) { return std::max({lo, hi, 0.0}); };
    const double outside =
        length(Vec3d(beyond(below.x, above.x), beyond(below.y, above.y), beyond(below.z, above.z)));
    return std::max(outside, box.diagonal() / 16);
  }

  // The steps of a random walk must change the coordinates.
  void take_mean_free_path() {
    const Media& media = scene_.media;
    if (!plan_.technique->interreflects || !media.scatters()) return;
    double rate = 0;
    for (std::size_t i = 0; i < media.bodies.size(); ++i)
      if (media.closed[i] != 0 && media.bodies[i].scatters())
        rate = std::max(rate, max_component(-media.bodies[i].log2_filter));
    const double path = 1 / (rate * std::numbers::ln2);
    take_length(path, "the mean free path in " + media.scattering + " or another body is " + metres(path));
  }

  // Limits the error of the ray direction after the last mirror.
  void take_mirrors() {
    const MirrorChain& chain = facts_.mirrors;
    if (chain.where.empty() || plan_.asked.max_depth.value_or(0) < 1) return;
    const double growth = std::pow(chain.growth, *plan_.asked.max_depth);
    take({kMaxTurn * chain.radius / (kRoundingsOfHit * magnitude_.value * growth),
          "each of " + std::to_string(*plan_.asked.max_depth) + " reflections from " + chain.where +
              " may multiply the rounding error by " + number_text(chain.growth)});
  }

  // Limits the turns that rounding errors of float cause along mirrored camera rays.
  void take_turns() {
    const int depth = std::min(plan_.asked.max_depth.value_or(0), MirrorTurns::kDepths);
    if (depth < 1 || facts_.turns.largest == 0) return;
    // The turns were measured with the eye of the scene, which may be nearer than that of the plan.
    const double turn =
        facts_.turns.after[static_cast<std::size_t>(depth - 1)] * std::max(1.0, magnitude_.value / measured_);
    take({kMaxTurnOfPaths * double{std::numeric_limits<float>::epsilon()} / turn,
          std::to_string(depth) + " reflections of mirrors such as " + facts_.turns.where +
              " may turn rays by " + number_text(turn) + " radians in float (RMS)"});
  }

  const Scene& scene_;
  const SceneFacts& facts_;
  const Plan& plan_;
  const double measured_;  // largest coordinate with the eye of the scene
  LocatedValue magnitude_;
  RoundingLimit strictest_;
};

}  // namespace

RoundingLimit rounding_limit(const Scene& scene, const Plan& plan) { return Limits(scene, plan).strictest(); }

}  // namespace orrery
