#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <vector>

#include "core/plan/request.h"
#include "server/app/pictures.h"
#include "server/app/render_services.h"

namespace orrery {

// What is refined, and for whom.
struct RefinementSpec {
  std::shared_ptr<const PreparedScene> scene;
  RenderRequest request;
  Plan plan;  // of the request
  std::string client;
};

// One picture in passes of samples, each of which gives the PNG that would be made of all samples so far at
// once. No sample is traced twice. Each pass waits for its own turn, and between passes the film is all that
// is held. For one thread.
class Refinement {
 public:
  // A picture on the way to the last one.
  struct Step {
    int samples;  // a pixel
    std::shared_ptr<const Picture> picture;
    double render_ms = 0, encode_ms = 0;  // of this pass; 0 where the picture was kept
    std::uint64_t rays = 0;               // likewise
  };

  // `pictures`: where those of passes are kept, too. pass_time: that one pass may take.
  Refinement(RefinementSpec spec, const RenderServices& services, Pictures& pictures,
             std::chrono::seconds pass_time);

  const Scene& scene() const { return spec_.scene->scene(); }
  const Plan& plan() const { return spec_.plan; }
  // Whether the last picture is kept: it is then the only one, and nothing is rendered.
  bool is_known() const { return known_ != nullptr; }
  bool at_end() const { return next_ == samples_.size(); }

  // The next picture; none after the last. What a first pass throws as App::render(), a later one throws as
  // well, except that it is not turned away for what waits already. Nothing comes after what it throws.
  std::optional<Step> next(const std::stop_token& gone);

 private:
  Step render(int samples, const std::stop_token& stop, Stage& stage);
  std::string key_of(int samples) const;

  const RefinementSpec spec_;
  const RenderServices services_;
  Pictures& pictures_;
  const std::chrono::seconds pass_time_;
  const std::vector<int> samples_;  // after each pass
  const std::shared_ptr<const Picture> known_;
  const std::shared_ptr<MemoryAccount> memory_;
  std::unique_ptr<ProgressiveRender> progress_;  // none before the first pass
  std::size_t next_ = 0;
  int done_ = 0;  // samples
};

}  // namespace orrery
