#pragma once

#include <memory>
#include <vector>

#include "core/image/decode/picture.h"
#include "core/model/asset_source.h"
#include "core/model/texture.h"

namespace orrery {

// Continuation of an image outside [0, 1].
enum class Wrap { repeat, mirror, clamp };

// Image in linear light with a pyramid of smaller copies. Level 0 is the image, and each level has half the
// sides of the level before, rounded up, down to one texel. A texel of a level is the mean of its area in the
// level before, so the mean of the image is the same at every level.
class ImageLevels {
 public:
  struct Level {
    int width, height;
    std::shared_ptr<const std::vector<float>> rgb;  // red, green, blue per texel; top row first
  };

  // Keeps the image as level 0. Throws Cancelled.
  explicit ImageLevels(const TexelsPtr& image);

  const std::vector<Level>& levels() const { return levels_; }
  // Return the number of texels and the bounds of level 0.
  std::size_t texels() const { return levels_.front().rgb->size() / 3; }
  const TextureBounds& bounds() const { return bounds_; }

 private:
  std::vector<Level> levels_;
  TextureBounds bounds_;
};

// Continuous image: u runs from 0 at the left to 1 at the right, v from 0 at the bottom to 1 at the top.
class ImagePyramid {
 public:
  ImagePyramid(ImageLevelsPtr levels, Wrap along_u, Wrap along_v)
      : levels_(std::move(levels)), along_u_(along_u), along_v_(along_v) {}
  ImagePyramid(const TexelsPtr& image, Wrap along_u, Wrap along_v)
      : ImagePyramid(std::make_shared<const ImageLevels>(image), along_u, along_v) {}

  const std::vector<ImageLevels::Level>& levels() const { return levels_->levels(); }

  // Returns the colour at (u, v), interpolated bilinearly between texel centres of the two levels around
  // `level`, and linearly between the levels. REQUIRES: u and v are finite, and `level` is at least 0.
  template <class T>
  Vec3<T> at(T u, T v, T level) const;

 private:
  template <class T>
  Vec3<T> bilinear(const ImageLevels::Level& level, T u, T v) const;

  ImageLevelsPtr levels_;
  Wrap along_u_, along_v_;
};

}  // namespace orrery
