#pragma once

#include "core/model/accelerator.h"

// Prediction of occluders, in front of any accelerator. A proposed primitive is tested against the shadow
// ray. If the ray hits the primitive, the ray is occluded and the accelerator is skipped. Otherwise the
// accelerator traces the ray. Results are therefore exact for any prediction, and only the time changes (the
// check of Liu et al., "Intersection Prediction for Accelerated GPU Ray Tracing", MICRO 2021).
namespace orrery {

// Proposes occluders. Immutable and thread-safe.
template <class T>
class Predictor {
 public:
  virtual ~Predictor() = default;

  // Sets the proposed occluder of each ray of `groups`, or kNoPrimitive. Numbers that are out of range are
  // ignored.
  virtual void propose(const RayBatch<T>& rays, const LaneGroups& groups,
                       Array<IndexOf<T>>& primitive) const = 0;
};
template <class T>
using PredictorPtr = std::shared_ptr<const Predictor<T>>;

// Returns a predictor for comparisons. The predictor proposes one of `count` primitives per register,
// selected by a hash of the register's first ray.
template <class T>
PredictorPtr<T> random_predictor(int count);

// Returns an accelerator whose occlude() calls `behind` only for rays that no proposed occluder blocks.
// `primitives` must outlive the result.
template <class T>
std::shared_ptr<const Accelerator<T>> predicted(const PrimitiveList<T>& primitives,
                                                std::shared_ptr<const Accelerator<T>> behind,
                                                PredictorPtr<T> predictor);

// Returns an accelerator that proposes the last occluder found in the same call of occlude(). The accelerator
// keeps no state between calls. `primitives` must outlive the result.
template <class T>
std::shared_ptr<const Accelerator<T>> predicted_by_last(const PrimitiveList<T>& primitives,
                                                        std::shared_ptr<const Accelerator<T>> behind);

}  // namespace orrery
