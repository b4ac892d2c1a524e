#include "core/image/image.h"

#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdlib>
#include <cstring>
#include <new>

#include "core/image/srgb.h"
#include "core/math/lanes.h"

namespace orrery {
namespace {

constexpr std::size_t kHugePage = std::size_t{1} << 21;

// Returns the nearest sRGB codes, 0..255, of linear values. NaN gives 0.
[[gnu::always_inline]] inline IndexLanes<float> srgb_codes(const Lanes<float>& linear) {
  return stdx::static_simd_cast<IndexLanes<float>>(encode_srgb(linear) * 255.0f + 0.5f);
}

}  // namespace

void Image::Free::operator()(std::byte* p) const { std::free(p); }

Image::Image(int width, int height, PixelFormat format) : width_(width), height_(height), format_(format) {
  const std::size_t size = row_bytes() * static_cast<std::size_t>(height);
  const std::size_t alignment = size >= kHugePage ? kHugePage : 64;
  const std::size_t rounded = (size + alignment - 1) / alignment * alignment;
  charge_ = MemoryCharge(rounded);
  data_.reset(static_cast<std::byte*>(std::aligned_alloc(alignment, rounded)));
  if (!data_) throw std::bad_alloc();
  if (alignment == kHugePage)
    madvise(data_.get(), rounded, MADV_HUGEPAGE);  // reduces page faults; failure is harmless
}

void Image::set_row(int x, int y, int count, const float* red, const float* green, const float* blue) {
  std::byte* out =
      data_.get() + static_cast<std::size_t>(y) * row_bytes() + static_cast<std::size_t>(x) * pixel_bytes();
  if (format_ == PixelFormat::linear32) {
    for (int i = 0; i < count; ++i) {
      const float pixel[3] = {red[i], green[i], blue[i]};
      std::memcpy(out + static_cast<std::size_t>(i) * sizeof pixel, pixel, sizeof pixel);
    }
    return;
  }
  constexpr int kLanes = kWidth<float>;
  alignas(64) std::array<std::uint32_t, kLanes> pixels;  // red in the lowest byte
  for (int from = 0; from < count; from += kLanes) {
    const auto codes = srgb_codes(load(red + from)) | srgb_codes(load(green + from)) << 8 |
                       srgb_codes(load(blue + from)) << 16;
    codes.copy_to(pixels.data(), stdx::vector_aligned);
    const auto lanes = static_cast<std::size_t>(std::min(kLanes, count - from));
    // Each store but the last writes a fourth byte, which the next pixel overwrites.
    for (std::size_t i = 0; i + 1 < lanes; ++i, out += 3) std::memcpy(out, &pixels[i], 4);
    std::memcpy(out, &pixels[lanes - 1], 3);
    out += 3;
  }
}

std::span<const float> Image::values() const {
  assert(format_ == PixelFormat::linear32);
  return {reinterpret_cast<const float*>(data_.get()), bytes().size() / sizeof(float)};
}

Vec3f Image::linear(int x, int y) const {
  const std::byte* pixel =
      data_.get() + static_cast<std::size_t>(y) * row_bytes() + static_cast<std::size_t>(x) * pixel_bytes();
  if (format_ == PixelFormat::srgb8) {
    const auto value = [&](int c) { return decode_srgb(static_cast<float>(pixel[c]) / 255.0f); };
    return {value(0), value(1), value(2)};
  }
  std::array<float, 3> values;
  std::memcpy(values.data(), pixel, sizeof values);
  return {values[0], values[1], values[2]};
}

Image Image::copy() const {
  Image copy(width_, height_, format_);
  std::memcpy(copy.data_.get(), data_.get(), bytes().size());
  return copy;
}

Image srgb_of(const Image& linear) {
  constexpr int kAtOnce = 256;
  Image encoded(linear.width(), linear.height(), PixelFormat::srgb8);
  alignas(64) std::array<std::array<float, kAtOnce>, 3> row;
  const float* value = linear.values().data();
  for (int y = 0; y < linear.height(); ++y)
    for (int x = 0; x < linear.width(); x += kAtOnce) {
      const int count = std::min(kAtOnce, linear.width() - x);
      for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
        for (auto& channel : row) channel[i] = *value++;
      encoded.set_row(x, y, count, row[0].data(), row[1].data(), row[2].data());
    }
  return encoded;
}

}  // namespace orrery
