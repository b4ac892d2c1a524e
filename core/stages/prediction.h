#pragma once

#include "core/model/accelerator.h"

// Prediction of occluders, in front of any accelerator. A primitive that is proposed for a shadow ray is held
// against it by its own kernel: if they meet the ray is occluded, and the accelerator need not be asked. That
// a ray reaches its light is never believed. So answers are exact whatever is proposed; only the time changes
// (the check of Liu et al., "Intersection Prediction for Accelerated GPU Ray Tracing", MICRO 2021).
namespace orrery {

// Const and free of state: any number of threads may call it at once.
template <class T>
class Predictor {
 public:
  virtual ~Predictor() = default;

  // Sets what may stand in the way of each ray of `groups`: any number, kNoPrimitive for nothing.
  virtual void propose(const RayBatch<T>& rays, const Groups& groups, Array<IndexOf<T>>& primitive) const = 0;
};
template <class T>
using PredictorPtr = std::shared_ptr<const Predictor<T>>;

// The control: for each register one primitive of `count`, by the bits of its first ray.
template <class T>
PredictorPtr<T> random_predictor(int count);

// `behind`, asked only for what `predictor` could not prove. The primitives outlive it.
template <class T>
std::shared_ptr<const Accelerator<T>> predicted(const PrimitiveList<T>& primitives,
                                                std::shared_ptr<const Accelerator<T>> behind,
                                                PredictorPtr<T> predictor);

// The same with the primitive that was found last in the same call, which is all it remembers.
template <class T>
std::shared_ptr<const Accelerator<T>> predicted_by_last(const PrimitiveList<T>& primitives,
                                                        std::shared_ptr<const Accelerator<T>> behind);

}  // namespace orrery
