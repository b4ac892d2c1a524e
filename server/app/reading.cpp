#include "server/app/reading.h"

namespace orrery {

Reading::Reading(const MeshSource& meshes, Admission& admission, std::string client, std::size_t bytes,
                 std::stop_token stop)
    : meshes_(meshes),
      admission_(admission),
      demand_{Lane::interactive, std::move(client), cost_of_reading(bytes)},
      stop_(std::move(stop)) {
  constexpr std::size_t kSmall = 64 * 1024;  // read in about a millisecond
  if (bytes > kSmall) take_turn();
}

TriangleMesh Reading::asset(const std::string& sha256) const {
  if (!ticket_) take_turn();
  return meshes_.asset(sha256);
}

void Reading::take_turn() const {
  const auto start = Clock::now();
  ticket_.emplace(admission_.enter(demand_, stop_));
  waited_ms_ = milliseconds_since(start);
}

}  // namespace orrery
