#pragma once

#include <cstdint>
#include <vector>

#include "core/budget/renderer.h"
#include "core/plan/request.h"
#include "core/study/chart.h"

namespace orrery {

inline constexpr int kMaxChartSamples = 1024, kMaxChartRounds = 16;
inline constexpr std::int64_t kMaxChartPixels = std::int64_t{1} << 20;

// Charts speed against accuracy for one view of a scene. The configurations vary technique, ray depth,
// precision and samples, up to those of the view. The reference has the technique of the view, double
// precision and four times the samples of the highest configuration. Effects that this technique does not
// model are not counted as errors. The reference is the mean of two images with different seeds. Each round
// renders all configurations with another seed. After the first round, a configuration with the same rays and
// the same error as a simpler configuration is dropped. From the third round on, dominated configurations are
// not rendered. Not thread-safe. Throws InputError only from the constructor.
class Study {
 public:
  struct Extent {
    int samples = 64;  // per pixel, upper limit of 1, 4, 16, ...
    int rounds = 3;    // maximum images per configuration
    int width = 0;     // maximum width of the rendered images, in pixels; 0: the requested width
    int threads = 1;   // assumed by Chart::full_seconds()
  };
  // Charts the image of `view`. Throws InputError for more than kMaxChartPixels, and if `view` sets samples,
  // precision, layers, a budget or a view other than `picture`. `scene` must outlive the last call of add().
  // REQUIRES: samples in [1, kMaxChartSamples], rounds in [1, kMaxChartRounds].
  Study(const Scene& scene, const RenderRequest& view, const Extent& extent);

  // Returns the number of images to render: two for the reference, then the configurations, round by round.
  // The number decreases when a round makes later images unnecessary.
  int pictures() const { return kReferences + static_cast<int>(turns_.size()); }
  // Returns the request of an image, to be rendered as FilmStorage::linear32. REQUIRES: 0 <= number <
  // pictures().
  RenderRequest request(int number) const;
  // Adds the next image. Images are added in the order of their numbers.
  void add(const RenderResult& rendered);
  bool complete() const { return added_ == pictures(); }
  // Frees memory that only add() needs. add() must not be called afterwards.
  void end() { reference_ = std::vector<float>(); }

  const std::string& scene_id() const { return chart_.scene_id; }
  // Returns the chart. REQUIRES: complete().
  const Chart& chart() const { return chart_; }
  // Returns the request of a point's first round. REQUIRES: complete().
  RenderRequest request_of(const Point& point) const { return request(point.configuration, kReferences); }

 private:
  static constexpr int kReferences = 2;  // images averaged into the reference
  struct Turn {
    std::size_t point;
    int round;
  };

  void add_configurations(const Plan& plan, int max_samples);
  RenderRequest request(const Configuration& configuration, int seed_step) const;
  // Query strings of an image: at the requested size, and at most kPictureWidth pixels wide.
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
  std::vector<Turn> turns_;       // one per image of a point, rendered or pending
  std::vector<bool> same_;        // by point: has the same rays and error as a simpler model
  Chart chart_;
};

}  // namespace orrery
