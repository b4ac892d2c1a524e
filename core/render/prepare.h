#pragma once

#include <map>
#include <mutex>

#include "core/model/world.h"
#include "core/render/renderer.h"

namespace orrery {

// The worlds built for one scene so far, by accelerator.
struct PreparedScene::Parts {
  std::shared_ptr<const Scene> scene;
  std::mutex mutex;  // guards the maps; a world is built under it, so that it is built once
  std::map<const AcceleratorType*, std::unique_ptr<World<float>>> float_worlds;
  std::map<const AcceleratorType*, std::unique_ptr<World<double>>> double_worlds;
};

// The scene in the plan's precision with the plan's accelerator; adds the milliseconds spent building, if
// any.
template <class T>
const World<T>& world_for(PreparedScene::Parts& parts, const AcceleratorType& accelerator, double& build_ms);

}  // namespace orrery
