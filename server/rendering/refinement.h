#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/render/progressive.h"
#include "server/cache/pictures.h"
#include "server/rendering/render_services.h"

namespace orrery {

// Progressive render of one image. Each pass adds samples and returns the same PNG as a single render with
// that many samples. No sample is traced twice. Each pass waits for its own slot. No slot is held between
// passes. Not thread-safe.
class Refinement {
 public:
  // Image after a pass.
  struct Step {
    int samples;  // per pixel
    std::shared_ptr<const Picture> picture;
    double render_ms = 0, encode_ms = 0;  // this pass; 0 if the image was cached
    std::uint64_t rays = 0;               // this pass
  };

  // `order`: final image, without a budget. `pictures`: cache for the images of the passes. Each pass may
  // take request_seconds.
  Refinement(RenderOrder order, const RenderServices& services, Pictures& pictures);

  const Scene& scene() const { return order_.scene->scene(); }
  const Plan& plan() const { return order_.plan; }
  // Returns whether the final image is cached. If so, it is the only step, and nothing is rendered.
  bool is_known() const { return known_ != nullptr; }
  bool at_end() const { return next_ == samples_.size(); }

  // Returns the next image, or nullopt after the last image and after an exception. While draining, only the
  // first image is returned. Throws the errors of RenderService::render(), but later passes are not rejected
  // if the queue is full.
  std::optional<Step> next();

 private:
  Step render(int samples, const std::stop_token& stop, RequestTrace& trace);
  std::string key_of(int samples) const;

  const RenderOrder order_;
  const RenderServices services_;
  Pictures& pictures_;
  const std::vector<int> samples_;  // samples per pixel after each pass
  const std::shared_ptr<const Picture> known_;
  const std::shared_ptr<WorkAccount> memory_;
  PoolExecutor executor_;
  std::unique_ptr<ProgressiveRender> progress_;  // null before the first pass
  std::size_t next_ = 0;
  int done_ = 0;  // samples per pixel
};

}  // namespace orrery
