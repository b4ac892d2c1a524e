#pragma once

#include <memory>
#include <optional>

#include "core/model/light.h"

namespace orrery {

class AssetSource;
class Params;

// Environment light: radiance from infinity, received by rays that miss everything. Immutable and
// thread-safe.
class Environment {
 public:
  virtual ~Environment() = default;
  // Returns the radiance if it is the same in all directions, otherwise nullopt. A constant environment
  // becomes the background of the scene and needs no kernel.
  virtual std::optional<Vec3d> constant() const { return std::nullopt; }
  virtual Vec3d most() const = 0;                   // largest radiance over all directions, per channel
  virtual Vec3d least() const { return Vec3d(0); }  // lower bound over all directions, per channel
  // Returns true if LightKernel::sample_each() can sample directions toward bright regions.
  virtual bool sampled() const { return false; }
  // Returns a kernel with one light, the environment, at index 0. beyond() returns the radiance.
  // sample_each() samples directions if sampled() is true. sample() reports that no light arrives, and pdf()
  // sets 0.
  virtual LightKernelPtr<float> kernel(float) const = 0;
  virtual LightKernelPtr<double> kernel(double) const = 0;
};

struct EnvironmentType {
  const char* name;
  const char* summary;
  // Returns null if the input is invalid, and records the problem in the Params. Throws Cancelled.
  std::shared_ptr<const Environment> (*read)(Params&, const AssetSource&);
};

}  // namespace orrery
