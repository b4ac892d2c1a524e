#pragma once

#include <cstdint>
#include <vector>

#include "core/plan/request.h"
#include "core/render/renderer.h"
#include "core/study/chart.h"

namespace orrery {

inline constexpr int kMaxChartSamples = 1024, kMaxChartRounds = 16;
inline constexpr std::int64_t kMaxChartPixels = std::int64_t{1} << 20;

// Charts speed against accuracy for one picture of a scene. The configurations vary technique, ray depth,
// precision and samples up to those of the picture. The reference has the picture's technique, double
// precision and four times the samples of the highest configuration. Effects that this technique does not
// model are not counted as errors. Each round renders all configurations with a seed of its own; the
// reference has two. A configuration that does the same work as a simpler one is dropped after the first
// round. From the second round on, dominated configurations get no more rounds. Not thread-safe.
class Study {
 public:
  struct Extent {
    int samples = 64;  // highest configuration; 1, 4, 16, ... up to it
    int rounds = 3;    // maximum pictures per configuration
    int width = 0;     // pixels of the rendered pictures; 0: as requested, which is also the maximum
    int threads = 1;   // assumed by Chart::full_seconds()
  };
  // Charts the picture of `view`. Throws InputError (/image) for more than kMaxChartPixels, and
  // (/render/samples, /render/precision) if `view` sets an option that the chart varies. The scene must live
  // until complete(). REQUIRES: samples in 1..kMaxChartSamples, rounds in 1..kMaxChartRounds.
  Study(const Scene& scene, const RenderRequest& view, const Extent& extent);

  // Returns the number of pictures to render: two of the reference, then the configurations, round by round.
  // The number falls when a round makes later pictures unnecessary.
  int pictures() const { return kReferences + static_cast<int>(turns_.size()); }
  // Returns the request of picture 0 <= number < pictures(), to be rendered as FilmStorage::linear32.
  RenderRequest request(int number) const;
  // Adds the next picture, in order of their numbers.
  void add(const RenderResult& rendered);
  bool complete() const { return added_ == pictures(); }
  // Frees memory that only add() needs. No picture may follow.
  void end() { reference_ = std::vector<float>(); }

  const std::string& scene_id() const { return chart_.scene_id; }
  // Returns the chart. REQUIRES: complete().
  const Chart& chart() const { return chart_; }
  // Returns the request of a point's first round. REQUIRES: complete().
  RenderRequest request_of(const Point& point) const { return request(point.configuration, kReferences); }

 private:
  static constexpr int kReferences = 2;  // pictures averaged into the reference
  struct Turn {
    std::size_t point;
    int round;
  };

  void add_configurations(const Plan& plan, int max_samples);
  RenderRequest request(const Configuration& configuration, int seed_step) const;
  // Queries of a picture: at the requested size, and at most kPictureWidth wide.
  struct Plans {
    std::string whole, picture;
  };
  Plans plans_of(const RenderRequest& request) const;
  void add_reference(const RenderResult& rendered);
  void add_round(Point& point, const RenderResult& rendered);
  void end_round(int round);

  const Scene& scene_;
  RenderRequest view_;  // at the rendered size
  std::uint64_t seed_ = 0;
  int added_ = 0;
  std::vector<float> reference_;  // empty once complete
  std::vector<Turn> turns_;       // one per picture of a point, both rendered and still to come
  std::vector<bool> same_;        // by point: does the work of a simpler model
  Chart chart_;
};

}  // namespace orrery
