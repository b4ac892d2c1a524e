#include "core/textures/image_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/base/task_scope.h"
#include "core/image/srgb.h"
#include "core/math/elementary.h"
#include "core/model/asset_reader.h"

namespace orrery {
namespace {

using Level = ImageLevels::Level;

// Overlaps of `from` texels with half as many texels, rounded up, along one axis.
struct Halving {
  int from, to;

  explicit Halving(int count) : from(count), to((count + 1) / 2) {}

  // Calls visit(texel of this level, share) for each overlap of texel `t` of the next level. The shares add
  // up to 1.
  template <class Visit>
  void for_each(int t, const Visit& visit) const {
    const double size = static_cast<double>(from) / to, begin = t * size, end = (t + 1) * size;
    for (int f = static_cast<int>(begin); f < from && f < end; ++f) {
      const double overlap = std::min(end, f + 1.0) - std::max(begin, static_cast<double>(f));
      if (overlap > 0) visit(static_cast<std::size_t>(f), overlap / size);
    }
  }
};

Level next_level(const Level& from) {
  const Halving across(from.width), down(from.height);
  const auto old_width = static_cast<std::size_t>(from.width);
  std::vector<float> rgb;
  rgb.reserve(static_cast<std::size_t>(across.to) * static_cast<std::size_t>(down.to) * 3);
  for (int row = 0; row < down.to; ++row) {
    checkpoint();
    for (int column = 0; column < across.to; ++column) {
      std::array<double, 3> sum{};
      down.for_each(row, [&](std::size_t y, double down_share) {
        across.for_each(column, [&](std::size_t x, double across_share) {
          for (std::size_t c = 0; c < 3; ++c)
            sum[c] += down_share * across_share * double{(*from.rgb)[(y * old_width + x) * 3 + c]};
        });
      });
      for (const double value : sum) rgb.push_back(static_cast<float>(value));
    }
  }
  return {across.to, down.to, std::make_shared<const std::vector<float>>(std::move(rgb))};
}

// Returns the index of a texel after wrapping.
std::size_t wrapped(std::int64_t i, int size, Wrap wrap) {
  const std::int64_t n = size;
  switch (wrap) {
    case Wrap::repeat: return static_cast<std::size_t>(((i % n) + n) % n);
    case Wrap::mirror: {
      const std::int64_t m = ((i % (2 * n)) + 2 * n) % (2 * n);
      return static_cast<std::size_t>(m < n ? m : 2 * n - 1 - m);
    }
    case Wrap::clamp: break;
  }
  return static_cast<std::size_t>(std::clamp<std::int64_t>(i, 0, n - 1));
}

}  // namespace

ImageLevels::ImageLevels(const TexelsPtr& image) {
  levels_.push_back(
      {image->width, image->height, std::shared_ptr<const std::vector<float>>(image, &image->rgb)});
  while (levels_.back().width > 1 || levels_.back().height > 1) levels_.push_back(next_level(levels_.back()));
  bounds_ = {Vec3d(std::numeric_limits<double>::infinity()), Vec3d(0)};
  for (std::size_t k = 0; k < image->rgb.size(); k += 3) {
    checkpoint(k / 3);
    const Vec3d texel(image->rgb[k], image->rgb[k + 1], image->rgb[k + 2]);
    bounds_.least = {std::min(bounds_.least.x, texel.x), std::min(bounds_.least.y, texel.y),
                     std::min(bounds_.least.z, texel.z)};
    bounds_.most = largest(bounds_.most, texel);
  }
}

template <class T>
Vec3<T> ImagePyramid::bilinear(const Level& level, T u, T v) const {
  // Coordinates beyond this limit have no fraction in float; it also keeps the integers exact.
  constexpr T kFar = T(1 << 30);
  const auto place = [kFar](T coordinate, int size) {
    return std::clamp(coordinate * static_cast<T>(size) - T(0.5), -kFar, kFar);
  };
  const T x = place(u, level.width), y = place(T(1) - v, level.height);
  const T left = std::floor(x), top = std::floor(y), right_share = x - left, lower_share = y - top;
  const auto i = static_cast<std::int64_t>(left), j = static_cast<std::int64_t>(top);
  const auto texel = [&](std::int64_t column, std::int64_t row) {
    const std::vector<float>& rgb = *level.rgb;
    const std::size_t at = (wrapped(row, level.height, along_v_) * static_cast<std::size_t>(level.width) +
                            wrapped(column, level.width, along_u_)) *
                           3;
    return Vec3<T>(T(rgb[at]), T(rgb[at + 1]), T(rgb[at + 2]));
  };
  const auto mix = [](const Vec3<T>& a, const Vec3<T>& b, T share) { return a + (b - a) * share; };
  return mix(mix(texel(i, j), texel(i + 1, j), right_share),
             mix(texel(i, j + 1), texel(i + 1, j + 1), right_share), lower_share);
}

template <class T>
Vec3<T> ImagePyramid::at(T u, T v, T level) const {
  const std::vector<Level>& all = levels();
  const T last = static_cast<T>(all.size() - 1), place = std::min(level, last), below = std::floor(place);
  const auto index = static_cast<std::size_t>(below);
  const Vec3<T> fine = bilinear(all[index], u, v);
  if (!(place > below)) return fine;
  return fine + (bilinear(all[index + 1], u, v) - fine) * (place - below);
}

template Vec3<float> ImagePyramid::at(float, float, float) const;
template Vec3<double> ImagePyramid::at(double, double, double) const;

namespace {

template <class T>
class ImageMapKernel final : public TextureKernel<T> {
 public:
  using N = Lanes<T>;

  ImageMapKernel(std::shared_ptr<const ImagePyramid> image, T scale)
      : image_(std::move(image)),
        scale_(scale),
        width_(static_cast<T>(image_->levels().front().width)),
        height_(static_cast<T>(image_->levels().front().height)) {}

  // The level is log2 of the larger side of the box, in texels.
  void evaluate(const TexturePoints<T>& points, const LaneGroups& groups,
                Vec3Array<T>& value) const override {
    for (const int i : groups) {
      const N side = max_first(N(points.width.x.at(i) * N(width_)), N(points.width.y.at(i) * N(height_)));
      const N level = log2_normal(max_first(N(T(1)), side));
      for (int lane = i; lane < i + kWidth<T>; ++lane) {
        const T u = points.at.x[lane], v = points.at.y[lane];
        const T at_level = std::max(T(0), level[static_cast<std::size_t>(lane - i)]);
        value.set(lane, std::isfinite(u) && std::isfinite(v) ? image_->at<T>(u, v, at_level) * scale_
                                                             : Vec3<T>(T(0)));
      }
    }
  }

 private:
  std::shared_ptr<const ImagePyramid> image_;
  T scale_, width_, height_;
};

class ImageMap final : public Texture {
 public:
  ImageMap(const ImageLevelsPtr& image, Wrap along_u, Wrap along_v, double scale)
      : image_(std::make_shared<const ImagePyramid>(image, along_u, along_v)),
        scale_(scale),
        bounds_{image->bounds().least * scale, image->bounds().most * scale} {}
  TextureBounds bounds() const override { return bounds_; }
  double detail() const override {
    const auto& finest = image_->levels().front();
    return 1.0 / std::max(finest.width, finest.height);
  }
  TextureKernelPtr<float> kernel(float) const override { return make<float>(); }
  TextureKernelPtr<double> kernel(double) const override { return make<double>(); }

 private:
  template <class T>
  TextureKernelPtr<T> make() const {
    return std::make_unique<ImageMapKernel<T>>(image_, static_cast<T>(scale_));
  }
  std::shared_ptr<const ImagePyramid> image_;
  double scale_;
  TextureBounds bounds_;
};

// Returns the sRGB codes of an image, divided by the largest code. Linear images are returned unchanged.
// Codes of 8 bits are exact multiples of 1 / 65535 too, and encode_srgb() is accurate enough for 16 bits.
TexelsPtr as_codes(const TexelsPtr& image) {
  if (!image->from_srgb) return image;
  Texels codes = *image;
  for (std::size_t k = 0; k < codes.rgb.size(); ++k) {
    checkpoint(k);
    codes.rgb[k] = std::round(encode_srgb(codes.rgb[k]) * 65535) / 65535;
  }
  return std::make_shared<const Texels>(std::move(codes));
}

// Returns the alpha of an image as grey: 1 if the image has no alpha.
TexelsPtr alpha_of(const TexelsPtr& image) {
  Texels grey{image->width, image->height, {}, {}};
  grey.rgb.resize(image->rgb.size(), 1);
  for (std::size_t i = 0; i < image->alpha.size(); ++i) {
    checkpoint(i);
    std::fill_n(&grey.rgb[3 * i], 3, image->alpha[i]);
  }
  return std::make_shared<const Texels>(std::move(grey));
}

// Returns the levels of an image. Records a problem and returns null if it cannot be read.
ImageLevelsPtr read_levels(Params& p, const AssetSource& source, const PictureName& name,
                           const std::string& encoding) {
  return read_named(p, name.key, name.name, [&](const std::string&) {
    const std::string number = name.image ? std::to_string(*name.image) : "";
    return source.levels(std::string(name.key) + ' ' + encoding + ' ' + number + ' ' + name.name, [&] {
      const TexelsPtr image = picture_of(source, name);
      return std::make_shared<const ImageLevels>(encoding == "linear"  ? as_codes(image)
                                                 : encoding == "alpha" ? alpha_of(image)
                                                                       : image);
    });
  });
}

std::shared_ptr<const Texture> read_image_map(Params& p, const AssetSource& source) {
  const PictureName name = read_picture_name(p);
  const std::string encoding = p.choice("encoding",
                                        "Colours from sRGB codes, codes / 255 as they are, or the alpha of "
                                        "the image as grey. EXR and HDR files are linear.",
                                        {"srgb", "linear", "alpha"}, "srgb");
  constexpr std::array<std::string_view, 3> kWraps{"repeat", "mirror", "clamp"};  // in the order of Wrap
  const std::string wrap = p.choice("wrap", "Continuation of the image outside 0 to 1.", kWraps, "repeat"),
                    wrap_v = p.choice("wrap_v", "Continuation along v; default: that of `wrap`.", kWraps,
                                      derived(std::string_view(wrap)));
  const double scale =
      p.number("scale", "Factor of the values of the image.", {.min = 0, .max = kMaxColor}, 1.0);
  const ImageLevelsPtr levels = read_levels(p, source, name, encoding);
  if (!levels) return nullptr;
  const auto mode_of = [&](const std::string& mode) {
    return static_cast<Wrap>(std::find(kWraps.begin(), kWraps.end(), mode) - kWraps.begin());
  };
  return std::make_shared<const ImageMap>(levels, mode_of(wrap), mode_of(wrap_v), scale);
}

}  // namespace

TextureType image_map_type() {
  return {"image", "An image, averaged over the pixel by a pyramid of smaller copies.", read_image_map};
}

}  // namespace orrery
