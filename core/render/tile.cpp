#include "core/render/tile.h"

#include <algorithm>
#include <cstring>

#include "core/math/sampling.h"

namespace orrery {
namespace {

constexpr int kRow = 65536;  // pixels are numbered row by row as if rows were this long

// Numbers of a tile's pixels beside that of its first, by slot.
constexpr auto kPixels = [] {
  std::array<std::uint32_t, kBatch> numbers{};
  for (int slot = 0; slot < kBatch; ++slot)
    numbers[static_cast<std::size_t>(slot)] =
        static_cast<std::uint32_t>(tile_pixel(slot).y * kRow + tile_pixel(slot).x);
  return numbers;
}();

}  // namespace

template <class T>
TileRenderer<T>::TileRenderer(const World<T>& world, const Plan& plan)
    : plan_(plan), tracer_(make_tracer(*plan.technique, world, plan)) {
  samples_.u.values.fill(0.5f);
  samples_.v.values.fill(0.5f);
}

template <class T>
void TileRenderer<T>::render(int x0, int y0, std::stop_token stop, Image& image) {
  if (plan_.samples > 1) clear_sums();
  const std::uint64_t cut_before = stats_.counts.cut_rays;
  for (int sample = 0; sample < plan_.samples; ++sample) {
    if (sample > 0 && stop.stop_requested()) stopped_ = true;
    if (stopped_) return;
    if (plan_.samples > 1) place_samples(x0, y0, sample);
    generate_rays(plan_.camera, plan_.width, plan_.height, x0, y0, samples_, rays_);
    stopped_ = !tracer_->trace(rays_, result_, stats_.counts, stop);
    if (stopped_) return;
    if (plan_.samples > 1) add_sample();
  }
  take_mean();
  if (stats_.counts.cut_rays != cut_before) take_cut(x0, y0);
  write(x0, y0, image);
}

template <class T>
void TileRenderer<T>::place_samples(int x0, int y0, int sample) {
  const auto seed =
      combine_bits(static_cast<std::uint32_t>(plan_.seed), static_cast<std::uint32_t>(plan_.seed >> 32));
  const auto first = static_cast<std::uint32_t>(y0 * kRow + x0);
  for (int slot = 0; slot < kBatch; slot += kWidth<float>) {
    const BitLanes pixel = first + BitLanes(&kPixels[static_cast<std::size_t>(slot)], stdx::element_aligned);
    const auto point = stratified_point(static_cast<std::uint32_t>(sample), combine_bits(seed, pixel));
    samples_.u.put(slot, point.u);
    samples_.v.put(slot, point.v);
  }
}

template <class T>
void TileRenderer<T>::clear_sums() {
  for (auto* sum : {&sums_.red, &sums_.green, &sums_.blue, &sums_.cut}) sum->fill(0.0);
}

template <class T>
void TileRenderer<T>::add_sample() {
  const auto add = [](std::array<double, kBatch>& sum, const Array<T>& value) {
    for (std::size_t i = 0; i < kBatch; ++i) sum[i] += static_cast<double>(value.values[i]);
  };
  add(sums_.red, result_.radiance.x);
  add(sums_.green, result_.radiance.y);
  add(sums_.blue, result_.radiance.z);
  add(sums_.cut, result_.cut);
}

// The means over samples, and whether any of them is not a number.
template <class T>
void TileRenderer<T>::take_mean() {
  const double share = 1.0 / plan_.samples;
  const auto mean = [&](Array<float>& to, const Array<T>& only, const std::array<double, kBatch>& sum) {
    if (plan_.samples == 1)
      for (std::size_t i = 0; i < kBatch; ++i) to.values[i] = static_cast<float>(only.values[i]);
    else
      for (std::size_t i = 0; i < kBatch; ++i) to.values[i] = static_cast<float>(sum[i] * share);
  };
  mean(red_, result_.radiance.x, sums_.red);
  mean(green_, result_.radiance.y, sums_.green);
  mean(blue_, result_.radiance.z, sums_.blue);
  mean(cut_, result_.cut, sums_.cut);
  for (int i = 0; i < kBatch; i += kWidth<float>) {
    const Lanes<float> sum = red_.at(i) + green_.at(i) + blue_.at(i);
    stats_.non_finite_pixels += static_cast<std::uint64_t>(stdx::popcount(!(sum - sum == 0.0f)));
  }
}

template <class T>
void TileRenderer<T>::take_cut(int x0, int y0) {
  for (int slot = 0; slot < kBatch; ++slot) {
    const TilePixel p = tile_pixel(slot);
    if (x0 + p.x >= plan_.width || y0 + p.y >= plan_.height) continue;
    stats_.mean_cut += static_cast<double>(cut_[slot]);
    stats_.max_cut = std::max(stats_.max_cut, static_cast<double>(cut_[slot]));
  }
}

// From slots, which run in blocks of 4x4 pixels, to rows.
template <class T>
void TileRenderer<T>::write(int x0, int y0, Image& image) const {
  const int width = std::min(kTileSide, plan_.width - x0), height = std::min(kTileSide, plan_.height - y0);
  alignas(64) std::array<std::array<float, kTileSide>, 3> row;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < kTileSide; x += 4) {
      const int slot = (y / 4 * (kTileSide / 4) + x / 4) * 16 + y % 4 * 4;
      std::memcpy(&row[0][static_cast<std::size_t>(x)], &red_[slot], 4 * sizeof(float));
      std::memcpy(&row[1][static_cast<std::size_t>(x)], &green_[slot], 4 * sizeof(float));
      std::memcpy(&row[2][static_cast<std::size_t>(x)], &blue_[slot], 4 * sizeof(float));
    }
    image.set_row(x0, y0 + y, width, row[0].data(), row[1].data(), row[2].data());
  }
}

template <class T>
void TileRenderer<T>::add_to(RenderStats& stats) const {
  stats.counts.add(stats_.counts);
  stats.mean_cut += stats_.mean_cut;
  stats.max_cut = std::max(stats.max_cut, stats_.max_cut);
  stats.non_finite_pixels += stats_.non_finite_pixels;
}

template class TileRenderer<float>;
template class TileRenderer<double>;

}  // namespace orrery
