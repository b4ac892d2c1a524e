#pragma once

#include "core/model/scene.h"

namespace orrery {

// Sets facts.tree_radiance, distributed_radiance, path_radiance and albedo. REQUIRES: the other facts are
// set. used[i] is true if at least one primitive uses material i.
void find_radiance_ranges(const Scene& scene, const std::vector<bool>& used, SceneFacts& facts);

}  // namespace orrery
