#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "core/image/image.h"
#include "core/model/channel.h"
#include "core/model/tile.h"

namespace orrery {

// How a film keeps what was rendered.
enum class FilmStorage {
  srgb8,     // 3 bytes a pixel: radiance resolved for the eye as soon as a tile has ended
  linear32,  // 12 bytes a pixel: radiance resolved to linear floats
  sums       // 8 bytes a pixel, component and channel: sums in double precision, to which passes can be added
};

// Sums over the samples of one tile, by slot, in the order of the samples. Precision: double.
struct TileSums {
  using Plane = std::array<double, kBatch>;
  struct Sums {
    std::array<Plane, 3> value;
    Plane weight;  // samples that count
  };
  std::array<Plane, 3> radiance;
  std::vector<Sums> channels;  // of the film, in its order
  int samples = 0;
};

// Mean radiance of one tile, by slot.
using TileMeans = std::array<Array<float>, 3>;

// A picture while it is made: sums over samples, by channel. Several threads may put different tiles at once.
class Film {
 public:
  // Channels are kept with FilmStorage::sums alone. REQUIRES: none otherwise.
  Film(int width, int height, FilmStorage storage, std::span<const ChannelType* const> channels = {});

  // Another with the same sums. REQUIRES: FilmStorage::sums.
  Film copy() const;

  // Bytes that such a film takes.
  static std::size_t bytes(int width, int height, FilmStorage storage,
                           std::span<const ChannelType* const> channels);

  int width() const { return width_; }
  int height() const { return height_; }
  FilmStorage storage() const { return storage_; }
  std::span<const ChannelType* const> channels() const { return channels_; }

  // Sets the tile's pixels to these sums. Returns how many of its pixels are not finite.
  std::uint64_t put(const TileView& tile, const TileSums& sums);
  // Likewise from means, which a film of sums cannot take. REQUIRES: not FilmStorage::sums.
  std::uint64_t put(const TileView& tile, const TileMeans& means);
  // The sums that were put. REQUIRES: FilmStorage::sums; the tile was put.
  void take(const TileView& tile, TileSums& sums) const;

  // Mean radiance in either format. REQUIRES: all tiles were put; the film is not srgb8 where linear32 is
  // asked for.
  Image image(PixelFormat format) const;
  // The picture as it is kept. REQUIRES: not FilmStorage::sums.
  const Image& stored() const { return *image_; }

  // Mean of a component of a channel, row by row; ChannelType::nothing where no sample met anything.
  // REQUIRES: FilmStorage::sums.
  std::vector<float> values(std::size_t channel, std::size_t component) const;

 private:
  using Plane = std::vector<double>;
  struct ChannelPlanes {
    std::array<Plane, 3> value;
    Plane weight;
  };
  int tile_number(const TileView& tile) const;
  Image resolved() const;

  int width_, height_;
  FilmStorage storage_;
  std::vector<const ChannelType*> channels_;
  std::unique_ptr<Image> image_;  // unless sums are kept
  std::array<Plane, 3> radiance_;
  std::vector<ChannelPlanes> planes_;  // of each channel
  std::vector<int> samples_;           // of each tile of the grid
};

}  // namespace orrery
