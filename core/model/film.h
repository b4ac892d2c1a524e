#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "core/image/image.h"
#include "core/model/channel.h"
#include "core/model/tile.h"

namespace orrery {

// Storage format of a film.
enum class FilmStorage {
  srgb8,     // 3 bytes per pixel: sRGB-encoded when a tile is stored
  linear32,  // 12 bytes per pixel: radiance as linear floats
  sums       // 8 bytes per pixel and sum: doubles, to which further passes can be added
};

// Sums over the samples of one tile, one per batch element, added in sample order.
struct TileSums {
  using Plane = std::array<double, kBatch>;
  struct Sums {
    std::array<Plane, 3> value;
    Plane weight;  // number of samples in `value`
  };
  std::array<Plane, 3> radiance;
  std::vector<Sums> channels;  // in the film's order
  int samples = 0;
};

// Mean radiance of one tile, one value per batch element and channel.
using TileMeans = std::array<Array<float>, 3>;

// Accumulation buffer of a render: sums over samples, or the pixels of an image. Several threads may store
// different tiles at once. Functions that allocate throw std::bad_alloc.
class Film {
 public:
  // Creates an empty film. REQUIRES: `channels` is empty unless `storage` is FilmStorage::sums.
  Film(int width, int height, FilmStorage storage, std::span<const ChannelType* const> channels = {});

  // REQUIRES: storage() is FilmStorage::sums.
  Film copy() const;

  // Returns the size in bytes of the pixel data of a film with these arguments.
  static std::size_t bytes(int width, int height, FilmStorage storage,
                           std::span<const ChannelType* const> channels);

  int width() const { return width_; }
  int height() const { return height_; }
  FilmStorage storage() const { return storage_; }
  std::span<const ChannelType* const> channels() const { return channels_; }

  // Stores the sums of the tile if storage() is FilmStorage::sums, otherwise the means of the radiance.
  // Returns the number of non-finite pixels.
  std::uint64_t put(const TileView& tile, const TileSums& sums);
  // Stores means. Returns the number of non-finite pixels. REQUIRES: storage() is not FilmStorage::sums.
  std::uint64_t put(const TileView& tile, const TileMeans& means);
  // Loads the stored sums of the tile. REQUIRES: storage() is FilmStorage::sums, and the tile was stored.
  void take(const TileView& tile, TileSums& sums) const;

  // Returns the mean radiance in `format`. REQUIRES: all tiles were stored. `format` is srgb8 if storage() is
  // FilmStorage::srgb8.
  Image image(PixelFormat format) const;
  // Returns the stored image. REQUIRES: storage() is not FilmStorage::sums.
  const Image& stored() const { return *image_; }

  // Returns the means of a channel component, row by row. The value of a pixel without hits is
  // ChannelType::nothing. REQUIRES: storage() is FilmStorage::sums.
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
  std::unique_ptr<Image> image_;  // null for FilmStorage::sums
  std::array<Plane, 3> radiance_;
  std::vector<ChannelPlanes> planes_;  // by channel
  std::vector<int> samples_;           // by tile of the grid
};

}  // namespace orrery
