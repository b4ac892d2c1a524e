#pragma once

#include <optional>
#include <stop_token>
#include <string>

#include "core/model/asset_source.h"
#include "server/app/admission.h"

namespace orrery {

// Asset source for a scene that is being parsed. Small scenes without assets are parsed at once. Other scenes
// wait for a slot first and hold it as long as this object lives. For one thread.
class AssetReader final : public AssetSource {
 public:
  // `bytes`: size of the scene's text. Waits as Admission::enter() if it is large.
  AssetReader(const AssetSource& assets, Admission& admission, std::string client, std::size_t bytes,
              std::stop_token stop);

  TriangleMesh mesh_asset(const std::string& sha256) const override;
  TexelsPtr picture_asset(const std::string& sha256) const override;

  double waited_ms() const { return waited_ms_; }

 private:
  void take_turn() const;

  const AssetSource& assets_;
  Admission& admission_;
  const SlotRequest demand_;
  const std::stop_token stop_;
  mutable std::optional<Admission::Ticket> ticket_;
  mutable double waited_ms_ = 0;
};

}  // namespace orrery
