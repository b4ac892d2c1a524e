#include "core/accuracy/tile_halves.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/image/srgb.h"

namespace orrery {
namespace {

using Plane = TileSums::Plane;
// Row of a block of 4 x 4 pixels. Its width is the same at each SIMD level, so that sums have the same order.
using Four = stdx::fixed_size_simd<double, 4>;
constexpr std::size_t kBlock4 = 16;

Four four(const Plane& from, std::size_t slot) { return {&from[slot], stdx::element_aligned}; }
double sum_of(const Four& values) { return (values[0] + values[1]) + (values[2] + values[3]); }

// Returns 1 for each pixel inside the image, and 0 for the others.
Plane inside(const TileView& tile) {
  Plane is_inside;
  is_inside.fill(tile.is_whole() ? 1.0 : 0.0);
  if (!tile.is_whole()) for_each_slot(tile, [&](std::size_t i) { is_inside[i] = 1; });
  return is_inside;
}

// Mean radiance of each half. Rounding to float is smaller than the error of encode_srgb().
struct Shown {
  alignas(64) std::array<float, kBatch> first, second;
};
void find_means(const Plane& first, const Plane& all, double share, Shown& means) {
  for (std::size_t i = 0; i < kBatch; ++i) {
    means.first[i] = static_cast<float>(first[i] * share);
    means.second[i] = static_cast<float>((all[i] - first[i]) * share);
  }
}

}  // namespace

SampledError TileHalves::error() const {
  const double share = 1.0 / samples;
  const Plane is_inside = inside(tile);
  SampledError told;
  told.samples = samples;
  Four squares(0.0);
  std::array<Four, kBatch / kBlock4> of_blocks{};
  for (std::size_t c = 0; c < 3; ++c) {
    double sum_of_tile = 0;
    for (std::size_t block = 0; block < kBatch; block += kBlock4) {
      Four differences(0.0), counted(0.0), of_block(0.0);
      for (std::size_t i = block; i < block + kBlock4; i += Four::size()) {
        Four half_difference = (2.0 * four(first[c], i) - four(all[c], i)) * share;
        Four counts = four(is_inside, i);
        stdx::where(!(abs(half_difference) <= std::numeric_limits<double>::max()), counts) = 0.0;
        stdx::where(counts == 0.0, half_difference) = 0.0;
        squares += half_difference * half_difference;
        of_block += half_difference * half_difference;
        differences += half_difference;
        counted += counts;
      }
      const double sum = sum_of(differences), values = sum_of(counted);
      told.pixel.values += values;
      of_blocks[block / kBlock4] += of_block;
      if (c == 0 && values > 0) told.blocks += 1;
      sum_of_tile += sum;
      if (values < kBlock4) continue;
      told.block4.squares += sum * sum / (kBlock4 * kBlock4);
      told.block4.values += 1;
    }
    if (!tile.is_whole()) continue;
    told.block32.squares += sum_of_tile * sum_of_tile / (double{kBatch} * kBatch);
    told.block32.values += 1;
  }
  told.pixel.squares = sum_of(squares);
  if (told.pixel.values == 0) return {};  // no value is finite
  const double mean_square = told.pixel.squares / told.pixel.values;
  told.tiles = 1;
  told.tile_sum = mean_square;
  told.tile_squares = mean_square * mean_square;
  for (const Four& of_block : of_blocks) {
    const double sum = sum_of(of_block);
    told.block_sum += sum;
    told.block_squares += sum * sum;
  }
  return told;
}

void TileHalves::add_to(Halves& halves, const Plan& plan) const {
  const double scale = 2.0 / (samples * std::max(plan.sample_range, std::numeric_limits<double>::min()));
  Plane squares{};
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < kBatch; ++i) {
      const double difference = (2 * first[c][i] - all[c][i]) * scale;
      squares[i] += difference * difference;
    }
  double sum = 0;
  for_each_slot(tile, [&](std::size_t i) {
    if (!std::isfinite(squares[i])) return;
    halves.add(squares[i] / 3);
    sum += squares[i] / 3;
  });
  halves.add_tile(sum);
}

// The sRGB curve is concave, so noise darkens a displayed mean on average. The mean of both halves is
// darkened less than the mean of one half. The bias is estimated from the difference between the displayed
// mean of both halves and the average of the two displayed means.
void TileHalves::add_displayed_to(Halves& halves, const Plan& plan) const {
  using N = Lanes<float>;
  const N kOfBias(16.0f);  // counts twice the bias, because sums of squares are divided by 4 later
  const N one(1.0f), none(0.0f), half(0.5f), kCodes(255.0f);
  const double most = plan.beyond_range(samples);
  alignas(64) std::array<float, kBatch> squares{}, beyond{}, rounding{};
  Shown means;
  for (std::size_t c = 0; c < 3; ++c) {
    find_means(first[c], all[c], 2.0 / samples, means);
    for (std::size_t i = 0; i < kBatch; i += N::size()) {
      const N a = load(&means.first[i]), b = load(&means.second[i]);
      const N shown_a = encode_srgb(a), shown_b = encode_srgb(b), difference = shown_a - shown_b;
      const N shown = encode_srgb((a + b) * half), bias = shown - (shown_a + shown_b) * half;
      const N code = shown * kCodes, off = code - floor(code + half);
      const N square = load(&squares[i]) + (difference * difference + kOfBias * bias * bias);
      const N larger = max_first(a, b);
      const N cut = select(min_first(a, b) < one && larger > one, larger - one, none);
      square.copy_to(&squares[i], stdx::vector_aligned);
      (load(&beyond[i]) + cut).copy_to(&beyond[i], stdx::vector_aligned);
      (load(&rounding[i]) + off * off).copy_to(&rounding[i], stdx::vector_aligned);
    }
  }
  double sum = 0, rounding_sum = 0, codes = 0;
  for_each_slot(tile, [&](std::size_t i) {
    if (!std::isfinite(squares[i] + beyond[i])) return;
    rounding_sum += double{rounding[i]};
    codes += 3;
    const double value = std::min(1.0, double{squares[i]} / 3);
    halves.add(value);
    sum += value;
    if (most > 0) halves.add_beyond(std::min(double{beyond[i]} / 3, most), most);
  });
  halves.add_rounding(rounding_sum / (255.0 * 255.0), codes);
  halves.add_tile(sum);
}

}  // namespace orrery
