#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "core/base/task_scope.h"
#include "core/math/vec3.h"

// core/image: images in memory, and PNG, JPEG and EXR codecs (files.h).
//
// Threads: functions are thread-safe. An Image may be used by several threads if each writes different
// pixels. Errors: std::bad_alloc. files.h lists the errors of the codecs.
namespace orrery {

enum class PixelFormat {
  srgb8,    // 3 bytes per pixel, sRGB-encoded (IEC 61966-2-1), clamped to [0, 1]
  linear32  // 3 floats per pixel, linear, unbounded
};

// Image with row 0 at the top. Threads may write different pixels concurrently.
class Image {
 public:
  // Leaves the pixels uninitialised. Throws std::bad_alloc.
  Image(int width, int height, PixelFormat format);

  int width() const { return width_; }
  int height() const { return height_; }
  PixelFormat format() const { return format_; }

  // Sets pixels (x, y) to (x + count - 1, y) from linear colour. The channel arrays must be aligned to 64
  // bytes and readable up to the next multiple of 16 entries.
  void set_row(int x, int y, int count, const float* red, const float* green, const float* blue);

  std::size_t row_bytes() const { return static_cast<std::size_t>(width_) * pixel_bytes(); }
  std::size_t pixel_bytes() const { return format_ == PixelFormat::srgb8 ? 3 : 12; }
  std::span<const std::byte> bytes() const {
    return {data_.get(), row_bytes() * static_cast<std::size_t>(height_)};
  }
  std::span<std::byte> bytes() { return {data_.get(), row_bytes() * static_cast<std::size_t>(height_)}; }

  // Returns red, green and blue of all pixels, row by row. REQUIRES: linear32.
  std::span<const float> values() const;

  Image copy() const;

  // Returns the linear colour of a pixel in either format.
  Vec3f linear(int x, int y) const;

 private:
  struct Free {
    void operator()(std::byte* p) const;
  };
  int width_, height_;
  PixelFormat format_;
  MemoryCharge charge_;  // for data_
  std::unique_ptr<std::byte[], Free> data_;
};

// Converts an image to srgb8. REQUIRES: `linear` is linear32.
Image srgb_of(const Image& linear);

}  // namespace orrery
