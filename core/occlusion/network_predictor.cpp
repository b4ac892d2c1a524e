#include "core/occlusion/network_predictor.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/occlusion/network.h"

namespace orrery {
namespace {

constexpr int kNoOccluder = 0;  // answer for rays that no candidate occludes

// Returns up to 15 primitives that occlude the most samples, in descending order of the number of samples.
// Ties are sorted by primitive number.
std::vector<int> candidates_of(std::span<const OcclusionSample> samples) {
  std::map<int, int> met;
  for (const OcclusionSample& sample : samples)
    if (sample.occluder != kNoPrimitive) ++met[sample.occluder];
  std::vector<std::pair<int, int>> ranked;
  for (const auto& [primitive, times] : met) ranked.emplace_back(-times, primitive);
  std::sort(ranked.begin(), ranked.end());
  ranked.resize(std::min(ranked.size(), Network::kAnswers - 1));
  std::vector<int> candidates;
  for (const auto& [times, primitive] : ranked) candidates.push_back(primitive);
  return candidates;
}

// Returns the median of the finite values, or 0 if there are none.
double median(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Normalization of one coordinate of the ray origins to (-1, 1). Half of the samples are mapped to
// [-1/2, 1/2], so that distant origins do not compress the range of the others.
struct CoordinateNormalization {
  double middle = 0, scale = 0;

  explicit CoordinateNormalization(std::vector<double> values) : middle(median(values)) {
    for (double& value : values) value = std::abs(value - middle);
    const double half = median(std::move(values));
    if (half > 0) scale = 1 / half;
  }
  template <class N>
  N operator()(const N& x) const {
    using std::abs;
    using T = ScalarOf<N>;
    const N scaled = (x - static_cast<T>(middle)) * static_cast<T>(scale);
    return scaled / (T(1) + abs(scaled));
  }
};

std::vector<double> column(std::span<const OcclusionSample> samples, double Vec3d::*axis) {
  std::vector<double> values;
  for (const OcclusionSample& sample : samples) values.push_back(sample.ray.origin.*axis);
  return values;
}

struct InputNormalization {
  CoordinateNormalization x, y, z;

  explicit InputNormalization(std::span<const OcclusionSample> samples)
      : x(column(samples, &Vec3d::x)), y(column(samples, &Vec3d::y)), z(column(samples, &Vec3d::z)) {}
  template <class N>
  Network::Inputs<N> inputs(const Ray<N>& ray) const {
    return {x(ray.origin.x), y(ray.origin.y), z(ray.origin.z),
            ray.direction.x, ray.direction.y, ray.direction.z};
  }
};

template <class T>
class NetworkPredictor final : public Predictor<T> {
 public:
  explicit NetworkPredictor(std::span<const OcclusionSample> samples)
      : candidates_(candidates_of(samples)), normalization_(samples) {
    if (candidates_.empty()) return;
    std::vector<NetworkExample> examples;
    for (const OcclusionSample& sample : samples) {
      const auto candidate = std::find(candidates_.begin(), candidates_.end(), sample.occluder);
      const auto place = static_cast<std::size_t>(candidate - candidates_.begin());
      const bool one = candidate != candidates_.end();
      NetworkExample example{{}, one ? place + 1 : kNoOccluder};
      const auto inputs = normalization_.inputs(sample.ray);
      for (std::size_t i = 0; i < inputs.size(); ++i) example.in[i] = static_cast<float>(inputs[i]);
      examples.push_back(example);
    }
    network_ = train_network(examples);
  }

  // Proposes the most probable candidate, unless kNoOccluder is at least 10 times as probable. Scores are
  // log-odds, so a ratio of 10 is a difference of kProposalMargin. Nothing is proposed if the scores are NaN.
  void propose(const RayBatch<T>& rays, const LaneGroups& groups,
               Array<IndexOf<T>>& primitive) const override {
    for (const int i : groups) {
      IndexLanes<T> proposed(IndexOf<T>{kNoPrimitive});
      if (!candidates_.empty()) {
        Network::Scores<N> scores;
        network_.score(normalization_.inputs(rays.at(i)), scores);
        N best = scores[kNoOccluder] - N(T(kProposalMargin));
        for (std::size_t c = 0; c < candidates_.size(); ++c) {
          const auto better = scores[c + 1] > best;
          best = select(better, scores[c + 1], best);
          stdx::where(mask_cast<IndexLanes<T>>(better), proposed) = static_cast<IndexOf<T>>(candidates_[c]);
        }
      }
      primitive.put(i, proposed);
    }
  }

 private:
  using N = Lanes<T>;
  // ln 10. A test of a primitive costs about a tenth of the traversal that it may save.
  static constexpr double kProposalMargin = 2.3;

  std::vector<int> candidates_;
  InputNormalization normalization_;
  Network network_;
};

}  // namespace

template <class T>
PredictorPtr<T> network_predictor(std::span<const OcclusionSample> samples) {
  return std::make_shared<const NetworkPredictor<T>>(samples);
}

template PredictorPtr<float> network_predictor(std::span<const OcclusionSample>);
template PredictorPtr<double> network_predictor(std::span<const OcclusionSample>);

}  // namespace orrery
