#pragma once

#include <optional>
#include <stop_token>
#include <string>

#include "core/model/asset_source.h"
#include "server/scheduler/admission.h"

namespace orrery {

// Asset source for a scene that is being parsed. Small scenes without assets need no slot. Other scenes wait
// for a slot, which this object holds until its destruction. Not thread-safe.
class AssetReader final : public AssetSource {
 public:
  // `bytes`: size of the scene's JSON. If it is large, waits for a slot and throws the errors of
  // Admission::enter().
  AssetReader(const AssetSource& assets, Admission& admission, std::string client, std::size_t bytes,
              std::stop_token stop);

  MeshModelPtr model_asset(const std::string& sha256, const ModelState& state) const override;
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
