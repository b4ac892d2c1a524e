#include "core/render/tile.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace orrery {

template <class T>
TileRenderer<T>::TileRenderer(const World<T>& world, const Plan& plan)
    : plan_(plan), tracer_(make_tracer(*plan.technique, world, plan)) {
  samples_.u.values.fill(0.5f);
  samples_.v.values.fill(0.5f);
  for (auto* sum : {&sums_.red, &sums_.green, &sums_.blue, &sums_.cut}) sum->resize(kBatch);
}

template <class T>
void TileRenderer<T>::render(int x0, int y0, const std::function<bool()>& stop, Image& image) {
  for (auto* sum : {&sums_.red, &sums_.green, &sums_.blue, &sums_.cut}) std::fill(sum->begin(), sum->end(), 0.0);
  for (int sample = 0; sample < plan_.samples; ++sample) {
    if (sample > 0 && stop && stop()) stopped_ = true;
    if (stopped_) return;
    if (plan_.samples > 1) place_samples(x0, y0, sample);
    generate_rays(plan_.camera, plan_.width, plan_.height, x0, y0, samples_, rays_);
    tracer_->trace(rays_, result_, stats_.counts);
    add_sample();
  }
  write(x0, y0, image);
}

template <class T>
void TileRenderer<T>::place_samples(int x0, int y0, int sample) {
  const auto seed = combine_bits(static_cast<std::uint32_t>(plan_.seed), static_cast<std::uint32_t>(plan_.seed >> 32));
  for (int slot = 0; slot < kBatch; ++slot) {
    const TilePixel p = tile_pixel(slot);
    const auto pixel = static_cast<std::uint32_t>((y0 + p.y) * kMaxSide + x0 + p.x);
    const SamplePoint point = stratified_point(static_cast<std::uint32_t>(sample), combine_bits(seed, pixel));
    samples_.u[slot] = point.u;
    samples_.v[slot] = point.v;
  }
}

template <class T>
void TileRenderer<T>::add_sample() {
  for (int slot = 0; slot < kBatch; ++slot) {
    const auto i = static_cast<std::size_t>(slot);
    sums_.red[i] += static_cast<double>(result_.radiance.x[slot]);
    sums_.green[i] += static_cast<double>(result_.radiance.y[slot]);
    sums_.blue[i] += static_cast<double>(result_.radiance.z[slot]);
    sums_.cut[i] += static_cast<double>(result_.cut[slot]);
  }
}

template <class T>
void TileRenderer<T>::write(int x0, int y0, Image& image) {
  const double share = 1.0 / plan_.samples;
  const int width = std::min(kTileSide, plan_.width - x0), height = std::min(kTileSide, plan_.height - y0);
  alignas(64) std::array<std::array<float, kTileSide * kTileSide>, 3> rows;
  for (int slot = 0; slot < kBatch; ++slot) {
    const TilePixel p = tile_pixel(slot);
    if (p.x >= width || p.y >= height) continue;
    const auto i = static_cast<std::size_t>(slot), at = static_cast<std::size_t>(p.y * kTileSide + p.x);
    rows[0][at] = static_cast<float>(sums_.red[i] * share);
    rows[1][at] = static_cast<float>(sums_.green[i] * share);
    rows[2][at] = static_cast<float>(sums_.blue[i] * share);
    const double cut = sums_.cut[i] * share;
    stats_.mean_cut += cut;
    stats_.max_cut = std::max(stats_.max_cut, cut);
    if (!std::isfinite(rows[0][at] + rows[1][at] + rows[2][at])) ++stats_.non_finite_pixels;
  }
  for (int y = 0; y < height; ++y) {
    const auto row = static_cast<std::size_t>(y * kTileSide);
    image.set_row(x0, y0 + y, width, &rows[0][row], &rows[1][row], &rows[2][row]);
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
