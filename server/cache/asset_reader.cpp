#include "server/cache/asset_reader.h"

namespace orrery {

AssetReader::AssetReader(const AssetSource& assets, Admission& admission, std::string client,
                         std::size_t bytes, std::stop_token stop)
    : assets_(assets),
      admission_(admission),
      demand_{Priority::interactive, std::move(client), cost_of_reading(bytes)},
      stop_(std::move(stop)) {
  constexpr std::size_t kSmall = 64 * 1024;  // parsed in about 1 ms
  if (bytes > kSmall) take_turn();
}

MeshModelPtr AssetReader::model_asset(const std::string& sha256, const ModelState& state) const {
  if (!ticket_) take_turn();
  return assets_.model_asset(sha256, state);
}

TexelsPtr AssetReader::picture_asset(const std::string& sha256) const {
  if (!ticket_) take_turn();
  return assets_.picture_asset(sha256);
}

void AssetReader::take_turn() const {
  const auto start = Clock::now();
  ticket_.emplace(admission_.enter(demand_, stop_));
  waited_ms_ = milliseconds_since(start);
}

}  // namespace orrery
