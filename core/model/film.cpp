#include "core/model/film.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

#include "core/base/task_scope.h"

namespace orrery {
namespace {

void take_means(const TileSums& sums, TileMeans& means) {
  const double share = 1.0 / sums.samples;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < kBatch; ++i)
      means[c].values[i] = static_cast<float>(sums.radiance[c][i] * share);
}

// Returns the number of non-finite pixels of the tile. Ignores pixels outside the image.
std::uint64_t count_non_finite(const TileView& tile, const TileMeans& means) {
  bool all_finite = true;
  for (int i = 0; i < kBatch; i += kWidth<float>) {
    const Lanes<float> sum = means[0].at(i) + means[1].at(i) + means[2].at(i);
    all_finite = all_finite && all_of(sum - sum == 0.0f);
  }
  if (all_finite) return 0;
  std::uint64_t non_finite = 0;
  for_each_slot(tile, [&](std::size_t i) {
    non_finite += !std::isfinite(means[0].values[i] + means[1].values[i] + means[2].values[i]);
  });
  return non_finite;
}

// Returns the batch element of pixel (x, y) of a tile. REQUIRES: x is a multiple of 4. Elements are in blocks
// of 4x4 pixels, so the next three elements are the next pixels of the row.
std::size_t slot_of(int x, int y) {
  return static_cast<std::size_t>((y / 4 * (kTileSide / 4) + x / 4) * 16 + y % 4 * 4);
}

void set_rows(const TileView& tile, const TileMeans& means, Image& image) {
  alignas(64) std::array<std::array<float, kTileSide>, 3> row;
  for (int y = 0; y < tile.height; ++y) {
    for (int x = 0; x < kTileSide; x += 4)
      for (std::size_t c = 0; c < 3; ++c)
        std::memcpy(&row[c][static_cast<std::size_t>(x)], &means[c].values[slot_of(x, y)], 4 * sizeof(float));
    image.set_row(tile.x0, tile.y0 + y, tile.width, row[0].data(), row[1].data(), row[2].data());
  }
}

// Calls visit(pixel index in the image, batch element) for each pixel of the tile.
template <class Visit>
void for_each_pixel(const TileView& tile, int width, const Visit& visit) {
  for (int y = 0; y < tile.height; ++y)
    for (int x = 0; x < tile.width; ++x)
      visit(static_cast<std::size_t>(tile.y0 + y) * static_cast<std::size_t>(width) +
                static_cast<std::size_t>(tile.x0 + x),
            slot_of(x, y) + static_cast<std::size_t>(x % 4));
}

std::size_t components(const ChannelType& channel) { return channel.components.size(); }

}  // namespace

Film::Film(int width, int height, FilmStorage storage, std::span<const ChannelType* const> channels)
    : width_(width), height_(height), storage_(storage), channels_(channels.begin(), channels.end()) {
  assert(storage == FilmStorage::sums || channels.empty());
  if (storage != FilmStorage::sums) {
    image_ = std::make_unique<Image>(
        width, height, storage == FilmStorage::srgb8 ? PixelFormat::srgb8 : PixelFormat::linear32);
    return;
  }
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  for (Plane& plane : radiance_) plane.resize(pixels);
  for (const ChannelType* channel : channels_) {
    ChannelPlanes& planes = planes_.emplace_back();
    for (std::size_t c = 0; c < components(*channel); ++c) planes.value[c].resize(pixels);
    planes.weight.resize(pixels);
  }
  samples_.resize(static_cast<std::size_t>(TileGrid(width, height).size()));
}

Film Film::copy() const {
  const MemoryCharge room(bytes(width_, height_, storage_, channels_));
  Film other(width_, height_, storage_, channels_);
  other.radiance_ = radiance_;
  other.planes_ = planes_;
  other.samples_ = samples_;
  return other;
}

std::size_t Film::bytes(int width, int height, FilmStorage storage,
                        std::span<const ChannelType* const> channels) {
  std::size_t pixel = 3;
  if (storage == FilmStorage::linear32) pixel = 3 * sizeof(float);
  if (storage == FilmStorage::sums) {
    std::size_t planes = 3;
    for (const ChannelType* channel : channels) planes += components(*channel) + 1;
    pixel = planes * sizeof(double);
  }
  return pixel * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

int Film::tile_number(const TileView& tile) const {
  const int across = (width_ + kTileSide - 1) / kTileSide;
  return tile.y0 / kTileSide * across + tile.x0 / kTileSide;
}

std::uint64_t Film::put(const TileView& tile, const TileMeans& means) {
  set_rows(tile, means, *image_);
  return count_non_finite(tile, means);
}

std::uint64_t Film::put(const TileView& tile, const TileSums& sums) {
  TileMeans means;
  take_means(sums, means);
  if (storage_ != FilmStorage::sums) return put(tile, means);
  samples_[static_cast<std::size_t>(tile_number(tile))] = sums.samples;
  for_each_pixel(tile, width_, [&](std::size_t pixel, std::size_t slot) {
    for (std::size_t c = 0; c < 3; ++c) radiance_[c][pixel] = sums.radiance[c][slot];
    for (std::size_t k = 0; k < planes_.size(); ++k) {
      for (std::size_t c = 0; c < components(*channels_[k]); ++c)
        planes_[k].value[c][pixel] = sums.channels[k].value[c][slot];
      planes_[k].weight[pixel] = sums.channels[k].weight[slot];
    }
  });
  return count_non_finite(tile, means);
}

void Film::take(const TileView& tile, TileSums& sums) const {
  sums.samples = samples_[static_cast<std::size_t>(tile_number(tile))];
  for_each_pixel(tile, width_, [&](std::size_t pixel, std::size_t slot) {
    for (std::size_t c = 0; c < 3; ++c) sums.radiance[c][slot] = radiance_[c][pixel];
    for (std::size_t k = 0; k < planes_.size(); ++k) {
      for (std::size_t c = 0; c < components(*channels_[k]); ++c)
        sums.channels[k].value[c][slot] = planes_[k].value[c][pixel];
      sums.channels[k].weight[slot] = planes_[k].weight[pixel];
    }
  });
}

Image Film::resolved() const {
  Image image(width_, height_, PixelFormat::linear32);
  const TileGrid tiles(width_, height_);
  TileSums sums;
  sums.channels.resize(planes_.size());
  TileMeans means;
  for (int i = 0; i < tiles.size(); ++i) {
    const TileView tile = tiles.at(i, 0);
    take(tile, sums);
    take_means(sums, means);
    set_rows(tile, means, image);
  }
  return image;
}

Image Film::image(PixelFormat format) const {
  assert(format == PixelFormat::srgb8 || storage_ != FilmStorage::srgb8);
  if (!image_) return format == PixelFormat::linear32 ? resolved() : srgb_of(resolved());
  return image_->format() == format ? image_->copy() : srgb_of(*image_);
}

std::vector<float> Film::values(std::size_t channel, std::size_t component) const {
  const ChannelPlanes& planes = planes_[channel];
  const Plane& sum = planes.value[component];
  std::vector<float> values(sum.size(), channels_[channel]->nothing);
  for (std::size_t i = 0; i < sum.size(); ++i)
    if (planes.weight[i] > 0) values[i] = static_cast<float>(sum[i] / planes.weight[i]);
  return values;
}

}  // namespace orrery
