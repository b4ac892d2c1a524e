#pragma once

#include <string>

namespace orrery {

// Returns the URL of a scene's image below `prefix`. `query` is from query_of():
// "/v1/scenes/5f0c/frame.png?samples=4".
inline std::string frame_path(const std::string& prefix, const std::string& scene_id,
                              const std::string& query) {
  return prefix + "/v1/scenes/" + scene_id + "/frame.png" + (query.empty() ? "" : "?" + query);
}

}  // namespace orrery
