#pragma once

#include <cstdint>
#include <vector>

#include "core/plan/request.h"
#include "core/render/renderer.h"
#include "core/study/chart.h"

namespace orrery {

inline constexpr int kMostChartSamples = 1024, kMostChartRounds = 16;
inline constexpr std::int64_t kMostChartPixels = std::int64_t{1} << 20;

// Charts speed against accuracy of one picture of a scene: a ladder of ways to make it (simpler techniques,
// shallower rays, both precisions, ever more samples) against the picture itself, by its own technique in
// double precision and with four times the samples of the highest configuration. What that technique does not
// model is no error here. The configurations take turns, round by round; each round has a seed of its own,
// and the reference two. What turns out to do the same as a simpler model is left out after the first round;
// from the second on, what is beaten gets no more. One thread at a time.
class Study {
 public:
  struct Extent {
    int samples = 64;  // of the highest configuration; 1, 4, 16, ... up to it
    int rounds = 3;    // pictures of each configuration, at most
    int width = 0;     // pixels, of the pictures that are rendered; 0, or more than was asked: as asked
    int threads = 1;   // that Chart::full_seconds() is predicted for
  };
  // Of the picture that `view` asks for. Throws what make_plan() does; InputError (/image) for more than
  // kMostChartPixels to be rendered, and (/render/samples, /render/precision) where `view` fixes what the
  // ladder varies. The scene must live until complete(). REQUIRES: samples in 1..kMostChartSamples, rounds
  // in 1..kMostChartRounds.
  Study(const Scene& scene, const RenderRequest& view, const Extent& extent);

  // Pictures to render: the reference twice, then the configurations, round by round. Fewer after a round
  // that has shown what needs no other.
  int pictures() const { return kReferences + static_cast<int>(turns_.size()); }
  // How the picture 0 <= number < pictures() is to be rendered, as FilmStorage::linear32.
  RenderRequest request(int number) const;
  // Takes the next picture; they come in order.
  void add(const RenderResult& rendered);
  bool complete() const { return added_ == pictures(); }
  // Gives back what only taking pictures needs. No more come.
  void end() { reference_ = std::vector<float>(); }

  const std::string& scene_id() const { return chart_.scene_id; }
  // REQUIRES: complete().
  const Chart& chart() const { return chart_; }
  // How the first round's picture of a point was rendered. REQUIRES: complete().
  RenderRequest request_of(const Point& point) const { return request(point.configuration, kReferences); }

 private:
  static constexpr int kReferences = 2;  // pictures that make the reference
  struct Turn {
    std::size_t point;
    int round;
  };

  void add_configurations(const Plan& plan, int most_samples);
  RenderRequest request(const Configuration& configuration, int seed_step) const;
  // Queries of that picture, at the size that was asked and at most kPictureWidth wide.
  struct Plans {
    std::string whole, picture;
  };
  Plans plans_of(const RenderRequest& request) const;
  void add_reference(const RenderResult& rendered);
  void add_round(Point& point, const RenderResult& rendered);
  void end_round(int round);

  const Scene& scene_;
  RenderRequest view_;  // of the size that is rendered
  std::uint64_t seed_ = 0;
  int added_ = 0;
  std::vector<float> reference_;  // empty once complete
  std::vector<Turn> turns_;       // of the points, those that were taken too
  std::vector<bool> same_;        // by point: as a simpler model does
  Chart chart_;
};

}  // namespace orrery
