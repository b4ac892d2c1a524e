#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/budget/renderer.h"
#include "core/plan/request.h"

namespace orrery {

inline constexpr std::int64_t kMaxHistoryPixels = std::int64_t{1} << 20;
inline constexpr int kHistorySamples = 64;  // default per pixel

// Image of a scene by one technique.
struct HistoryStep {
  const TechniqueType* technique = nullptr;
  std::vector<const char*> missing;  // kinds of light that the technique does not show: Plan::not_followed
  double cpu_ms = 0;                 // CPU time of tracing
  std::uint64_t rays = 0;            // traced rays; 0 for techniques that rasterize
  // Difference from the last step, in display values from 0 to 1: RMS over all pixels and channels, and
  // largest.
  double rms = 0, largest = 0;
};

// Renders a view of a scene by all techniques, in the order of their publication. All steps have the same
// number of samples. The last step, path tracing, is the reference. Not thread-safe. Throws InputError only
// from the constructor.
class History {
 public:
  // Throws InputError for more than kMaxHistoryPixels, for scan line techniques with a panorama, and if
  // `view` sets the technique, layers, a budget or a view other than `picture`. `scene` must outlive the last
  // call of add().
  History(const Scene& scene, const RenderRequest& view);

  int pictures() const { return static_cast<int>(steps_.size()); }
  // Returns the request of an image, to be rendered as FilmStorage::linear32. REQUIRES: 0 <= number <
  // pictures().
  RenderRequest request(int number) const;
  // Adds the next image. Images are added in the order of their numbers.
  void add(const RenderResult& rendered);
  bool complete() const { return images_.size() == steps_.size(); }

  const Scene& scene() const { return scene_; }
  int width() const { return width_; }
  int height() const { return height_; }
  int samples() const { return *view_.samples; }
  // Returns the steps. The members computed from images are set only if complete().
  const std::vector<HistoryStep>& steps() const { return steps_; }
  // Returns an image as PNG. REQUIRES: its image was added.
  const std::string& png(int number) const { return pngs_[static_cast<std::size_t>(number)]; }

 private:
  void compare_with_last();

  const Scene& scene_;
  RenderRequest view_;
  int width_ = 0, height_ = 0;
  std::vector<HistoryStep> steps_;
  std::vector<std::vector<float>> images_;  // display values
  std::vector<std::string> pngs_;
};

// Returns one sentence on what the technique does not show, such as "Does not show shadows or reflections.".
std::string missing_sentence(const HistoryStep& step);

// Draws the images side by side with their times, rays and errors. The SVG document contains the images.
// REQUIRES: history.complete().
std::string history_svg(const History& history);

}  // namespace orrery
