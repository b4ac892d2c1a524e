#pragma once

#include <cstdint>
#include <vector>

#include "core/plan/request.h"
#include "core/render/renderer.h"
#include "core/study/chart.h"

namespace orrery {

inline constexpr int kMostChartSamples = 1024, kMostChartRounds = 16;
inline constexpr std::int64_t kMostChartPixels = std::int64_t{1} << 20;

// Charts speed against accuracy of one picture of a scene: a ladder of ways to make it (simpler models,
// shallower rays, both precisions, ever more samples) against the picture itself in double precision and four
// times the samples of the highest configuration. The configurations take turns, round by round; each round
// has a seed of its own, and the reference two. What turns out to do the same as a simpler model is left out.
// One thread at a time.
class Study {
 public:
  struct Extent {
    int samples = 64;  // of the highest configuration; 1, 4, 16, ... up to it
    int rounds = 3;    // pictures of each configuration
  };
  // Of the picture that `view` asks for. Throws what make_plan() does; InputError (/image) for more than
  // kMostChartPixels, and (/render/samples, /render/precision) where `view` fixes what the ladder varies.
  // REQUIRES: samples in 1..kMostChartSamples, rounds in 1..kMostChartRounds.
  Study(const Scene& scene, const RenderRequest& view, const Extent& extent);

  // Pictures to render: the reference twice, then the configurations, round by round.
  int pictures() const { return pictures_; }
  // How the picture 0 <= number < pictures() is to be rendered, as FilmStorage::linear32.
  RenderRequest request(int number) const;
  // Takes the next picture; they come in order.
  void add(const RenderResult& rendered);
  bool complete() const { return added_ == pictures_; }

  const std::string& scene_id() const { return chart_.scene_id; }
  // REQUIRES: complete().
  const Chart& chart() const { return chart_; }

 private:
  void add_configurations(const Plan& plan, int most_samples);
  std::size_t place_of(int number) const;  // among the points
  void add_reference(const RenderResult& rendered);

  RenderRequest view_;
  std::uint64_t seed_ = 0;
  int pictures_ = 0, added_ = 0;
  std::vector<float> reference_;  // empty once complete
  Chart chart_;
};

}  // namespace orrery
