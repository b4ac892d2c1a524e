#pragma once

#include <memory>
#include <optional>

#include "core/model/asset_source.h"
#include "core/model/light.h"

namespace orrery {

class Params;

// What surrounds a scene: light from infinitely far away, seen by rays that meet nothing.
class Environment {
 public:
  virtual ~Environment() = default;
  // The radiance, if it is the same from everywhere: then no kernel is made.
  virtual std::optional<Vec3d> constant() const { return std::nullopt; }
  virtual Vec3d most() const = 0;  // the largest radiance from anywhere, per channel
  // Whether paths do better to draw directions toward it than to wait for them.
  virtual bool sampled() const { return false; }
  // It is light 0. Only beyond() and, if sampled(), sample_each() give light.
  virtual LightKernelPtr<float> kernel(float) const = 0;
  virtual LightKernelPtr<double> kernel(double) const = 0;
};

struct EnvironmentType {
  const char* name;
  const char* summary;
  // Null after a problem, which is noted.
  std::shared_ptr<const Environment> (*read)(Params&, const AssetSource&);
};

}  // namespace orrery
