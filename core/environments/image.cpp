#include "core/environments/light_map.h"
#include "core/math/angles.h"
#include "core/model/asset_reader.h"
#include "core/model/environment.h"

namespace orrery {
namespace {

// Light map with a rotation about +y and a scale.
struct TurnedMap {
  LightMap map;
  SineCosine turn;
  double scale;
};

template <class T>
class ImageKernel final : public LightKernel<T> {
 public:
  using N = Lanes<T>;

  explicit ImageKernel(std::shared_ptr<const TurnedMap> image)
      : image_(std::move(image)),
        sine_(static_cast<T>(image_->turn.sine)),
        cosine_(static_cast<T>(image_->turn.cosine)),
        scale_(static_cast<T>(image_->scale)),
        factor_(static_cast<T>(image_->map.density_factor())) {}

  void sample(const SurfaceBatch<T>&, const LightChoice<T>&, const PathDraws<T>&, const LaneGroups& groups,
              LightBatch<T>& out) const override {
    for (const int i : groups) out.shadow.t_max.put(i, N(T(-1)));
  }

  void sample_each(const SurfaceBatch<T>&, const LightChoices<T>& choices, const PathDraws<T>& draws,
                   const LaneGroups& groups, LightBatch<T>& out) const override {
    constexpr T kPi = std::numbers::pi_v<T>, kFar = std::numeric_limits<T>::infinity();
    for (const int i : groups) {
      const auto mine = mask_cast<N>(load_index<T>(choices.index, i) >= 0);
      if (!any(mine)) continue;
      const LightMap::Place<N> place =
          draw(draws.two(SampleSet::environment, i), draws.two(SampleSet::light, i));
      const auto [toward, sine] = image_->map.direction_of(place);
      const Found found = find(place, sine);
      const N pdf = found.pdf * choices.probability.at(i);
      const auto shines = pdf > N(T(0));
      out.shadow.direction.put(i, mine, out_of_map(toward));
      out.shadow.t_max.put(i, mine, select(shines, N(kFar), N(T(-1))));
      out.incident.put(i, mine, found.radiance * select(shines, N(T(1) / (kPi * pdf)), N(T(0))));
      out.pdf.put(i, mine, pdf);
    }
  }

  void beyond(const RayBatch<T>& rays, const LightChoice<T>& choice, const LaneGroups& groups,
              Vec3Array<T>& radiance, Array<T>& pdf) const override {
    for (const int i : groups) {
      const Vec3<N> toward = into_map(rays.direction.at(i));
      using std::sqrt;
      const Found found = find(image_->map.place_of(toward), sqrt(toward.x * toward.x + toward.z * toward.z));
      radiance.put(i, found.radiance);
      pdf.put(i, found.pdf * choice.probability);
    }
  }

 private:
  struct Found {
    Vec3<N> radiance;
    N pdf;  // per solid angle, of LightMap::draw()
  };
  // Returns the radiance and the density at a place. `sine` is the sine of the angle from +y.
  Found find(const LightMap::Place<N>& place, const N& sine) const {
    Found found;
    N by_texel;
    for (std::size_t lane = 0; lane < N::size(); ++lane) {
      const auto value = image_->map.at<T>(place.x[lane], place.y[lane]);
      found.radiance.x[lane] = value.radiance.x;
      found.radiance.y[lane] = value.radiance.y;
      found.radiance.z[lane] = value.radiance.z;
      by_texel[lane] = value.by_texel;
    }
    found.radiance = found.radiance * N(scale_);
    found.pdf = select(sine > N(std::numeric_limits<T>::min()), N(by_texel * (factor_ / sine)), N(T(0)));
    return found;
  }
  LightMap::Place<N> draw(const SamplePoint<N>& texel, const SamplePoint<N>& within) const {
    LightMap::Place<N> place;
    for (std::size_t lane = 0; lane < N::size(); ++lane) {
      const auto one = image_->map.draw<T>(texel.u[lane], texel.v[lane], within.u[lane], within.v[lane]);
      place.x[lane] = one.x;
      place.y[lane] = one.y;
    }
    return place;
  }
  Vec3<N> out_of_map(const Vec3<N>& v) const {
    return {v.x * cosine_ + v.z * sine_, v.y, v.z * cosine_ - v.x * sine_};
  }
  Vec3<N> into_map(const Vec3<N>& v) const {
    return {v.x * cosine_ - v.z * sine_, v.y, v.z * cosine_ + v.x * sine_};
  }

  const std::shared_ptr<const TurnedMap> image_;
  const T sine_, cosine_, scale_, factor_;
};

class ImageEnvironment final : public Environment {
 public:
  explicit ImageEnvironment(TurnedMap image) : image_(std::make_shared<const TurnedMap>(std::move(image))) {}
  bool sampled() const override { return image_->map.sampled() && image_->scale > 0; }
  Vec3d most() const override { return image_->map.most() * image_->scale; }
  LightKernelPtr<float> kernel(float) const override { return std::make_unique<ImageKernel<float>>(image_); }
  LightKernelPtr<double> kernel(double) const override {
    return std::make_unique<ImageKernel<double>>(image_);
  }

 private:
  const std::shared_ptr<const TurnedMap> image_;
};

std::shared_ptr<const Environment> read_image(Params& p, const AssetSource& source) {
  const TexelsPtr picture = read_picture(p, source);
  const double degrees =
      p.number("rotation_degrees", "Rotation about +y in degrees, anticlockwise as seen from above.",
               {.min = -1e6, .max = 1e6}, 0.0);
  const double scale = p.number("scale", "Factor by which the radiance of the image is multiplied.",
                                {.min = 0, .max = kMaxColor}, 1.0);
  if (!picture) return nullptr;
  return std::make_shared<ImageEnvironment>(
      TurnedMap{LightMap(*picture), sine_cosine_degrees(degrees), scale});
}

}  // namespace

EnvironmentType image_type() {
  return {"image", "An equirectangular image: centre toward -z, top toward +y, right half toward +x.",
          read_image};
}

}  // namespace orrery
