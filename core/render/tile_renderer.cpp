#include "core/render/tile_renderer.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/base/task_scope.h"
#include "core/cameras/shutter.h"
#include "core/cameras/thin_lens.h"
#include "core/render/color_scale.h"

namespace orrery {
namespace {

// Adds a sample to the sums. The first sample overwrites them.
template <class T>
void add(bool first, const Array<T>& value, TileSums::Plane& sum) {
  if (first)
    for (std::size_t i = 0; i < kBatch; ++i) sum[i] = static_cast<double>(value.values[i]);
  else
    for (std::size_t i = 0; i < kBatch; ++i) sum[i] += static_cast<double>(value.values[i]);
}

template <class T, class Planes>
void add_vector(bool first, const Vec3Array<T>& value, Planes& sums) {
  add(first, value.x, sums[0]);
  add(first, value.y, sums[1]);
  add(first, value.z, sums[2]);
}

// Adds the values of pixels with a weight above 0, whose rays hit something. `value` is undefined for the
// others.
template <class T>
void add_weighted(bool first, const Array<T>& value, const Array<T>& weight, TileSums::Plane& sum) {
  if (first) sum.fill(0.0);
  for (std::size_t i = 0; i < kBatch; ++i)
    if (weight.values[i] > 0) sum[i] += static_cast<double>(value.values[i]);
}

// Returns the ledger of the sums in `channels`, by channel and pixel. The sums are 0 if `channels` is empty.
// Uses absolute values, because filters with negative lobes may cause negative sums.
OmissionLedger ledger_of(const TileView& tile, std::span<const TileSums::Plane> channels) {
  double sum = 0, squares = 0, largest = 0;
  for (const TileSums::Plane& channel : channels)
    for_each_slot(tile, [&](std::size_t i) {
      const double off = std::fabs(channel[i]);
      sum += off;
      squares += off * off;
      largest = std::max(largest, off);
    });
  return {sum, squares, largest, 3.0 * tile.width * tile.height, tile.samples};
}

}  // namespace

template <class T>
TileRenderer<T>::TileRenderer(const World<T>& world, const Plan& plan)
    : plan_(plan),
      places_samples_(plan.samples > 1 || plan.technique->draws_light),
      tracer_(make_tracer(*plan.technique, world, plan)) {
  sums_.channels.resize(plan.channels.size());
  if (!plan.filtered) return;
  filter_.emplace(*plan.asked.filter, *plan.asked.filter_width);
  if (filter_->negative() > 0) negative_lobe_ = std::make_unique<TraceResult<T>>();
}

template <class T>
void TileRenderer<T>::render(const TileView& tile, Film& film) {
  omitted_.clear();
  begin_emission_rays(tile);
  if (places_samples_) find_streams(tile, SampleSet::pixel, pixel_streams_);
  if (plan_.samples == 1 && film.storage() != FilmStorage::sums && plan_.view == View::picture) {
    trace(tile, 0);
    put_single(tile, film);
  } else {
    sums_.samples = 0;
    if (tile.first_sample > 0) film.take(tile, sums_);
    const int end = tile.first_sample + tile.samples;
    for (int sample = tile.first_sample; sample < end; ++sample) {
      if (2 * sample == end) first_half_ = sums_.radiance;
      checkpoint();
      trace(tile, sample);
      add_sample();
    }
    if (end % 2 == 0 && 2 * tile.first_sample <= end) add_error({tile, first_half_, sums_.radiance, end});
    if (plan_.view == View::bound) show_bound(tile);
    stats_.non_finite_pixels += film.put(tile, sums_);
  }
  stats_.omitted.add(ledger_of(tile, omitted_));
  if (plan_.clamp_indirect > 0) add_clamped(tile);
}

template <class T>
void TileRenderer<T>::trace(const TileView& tile, int sample) {
  const bool is_first = sample == tile.first_sample;
  const std::uint64_t cut_before = stats_.counts.cut_rays;
  trace_part(tile, sample, PixelFilter::Part::positive, result_);
  if (negative_lobe_) {
    trace_part(tile, sample, PixelFilter::Part::negative, *negative_lobe_);
    subtract_negative_lobe();
  }
  if (plan_.clamp_indirect > 0) add_vector(is_first, result_.clamped, clamped_);
  if (stats_.counts.cut_rays == cut_before) return;
  const bool first = omitted_.empty();
  omitted_.resize(3);
  add_vector(first, result_.omitted, omitted_);
}

template <class T>
void TileRenderer<T>::trace_part(const TileView& tile, int sample, PixelFilter::Part part,
                                 TraceResult<T>& into) {
  const Draws draws(plan_.seed, tile, sample);
  if (places_samples_) place_samples(static_cast<std::uint32_t>(sample), pixel_streams_, part, samples_);
  send_rays(tile, samples_, draws, SampleSet::lens);
  tracer_->place(tile, samples_);
  tracer_->trace(rays_, draws, into, stats_.counts);
  trace_emission_only(tile, sample, part, into);
}

template <class T>
void TileRenderer<T>::subtract_negative_lobe() {
  using N = Lanes<T>;
  const N more(static_cast<T>(filter_->positive())), less(static_cast<T>(filter_->negative()));
  for (int i = 0; i < kBatch; i += kWidth<T>) {
    result_.radiance.put(i, result_.radiance.at(i) * more - negative_lobe_->radiance.at(i) * less);
    if (plan_.clamp_indirect > 0)
      result_.clamped.put(i, result_.clamped.at(i) * more - negative_lobe_->clamped.at(i) * less);
    result_.omitted.put(i, result_.omitted.at(i) * more + negative_lobe_->omitted.at(i) * less);
  }
}

template <class T>
void TileRenderer<T>::send_rays(const TileView& tile, const TileSamples& samples, const Draws& draws,
                                SampleSet set) {
  plan_.camera->generate(plan_.frame, plan_.width, plan_.height, tile, samples, rays_);
  if (plan_.lens) apply_thin_lens(plan_.frame, draws, set, rays_);
  if (plan_.shutter == 0) return;
  if (places_samples_)
    draw_times(draws, set, rays_);
  else
    put_middle_time(rays_);
}

// Stores the only sample of each pixel as the mean.
template <class T>
void TileRenderer<T>::put_single(const TileView& tile, Film& film) {
  const Array<T>* const radiance[] = {&result_.radiance.x, &result_.radiance.y, &result_.radiance.z};
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < kBatch; ++i) means_[c].values[i] = static_cast<float>(radiance[c]->values[i]);
  stats_.non_finite_pixels += film.put(tile, means_);
}

// Tests two opposite corners of each pixel, or of the filter's support. A block is varied if they differ
// within it, or if it or one of its eight neighbours differs from another.
template <class T>
auto TileRenderer<T>::find_varied_blocks(const TileView& tile) -> Blocks {
  constexpr int kSide = kTileSide / 4, kSize = 16;
  const LaneGroups all = LaneGroups::covering(0, kBatch, kWidth<T>);
  Blocks differs{}, known{}, varied{};
  std::array<Vec3<T>, kBatch / kSize> first;
  const float reach = filter_ ? filter_->half_width() : 0.5f;
  for (const float corner : {0.5f - reach, filter_ ? 0.5f + reach : 1.0f - 0x1p-24f}) {
    look_samples_.u.values.fill(corner);
    look_samples_.v.values.fill(corner);
    plan_.camera->generate(plan_.frame, plan_.width, plan_.height, tile, look_samples_, rays_);
    if (plan_.shutter > 0) put_middle_time(rays_);
    for (const int i : all) result_.radiance.put(i, Vec3<Lanes<T>>(Lanes<T>(T(0))));
    tracer_->trace_emission_only(rays_, all, T(1), result_, stats_.counts);
    for (int slot = 0; slot < kBatch; ++slot) {
      if (!(rays_.t_max[slot] > 0)) continue;
      const auto block = static_cast<std::size_t>(slot / kSize);
      if (!known[block]) first[block] = result_.radiance[slot];
      known[block] = true;
      differs[block] = differs[block] || result_.radiance[slot] != first[block];
    }
  }
  for (int i = 0; i < kSide * kSide; ++i)
    for (int k = 0; k < 9; ++k) {
      const int x = i % kSide + k % 3 - 1, y = i / kSide + k / 3 - 1;
      if (x < 0 || x >= kSide || y < 0 || y >= kSide) continue;
      const auto block = static_cast<std::size_t>(i), other = static_cast<std::size_t>(y * kSide + x);
      if (known[block] && known[other])
        varied[block] = varied[block] || differs[other] || first[other] != first[block];
    }
  return varied;
}

// Blocks of 4x4 pixels in which the emission may vary, or all with lens or motion blur, get
// kMaxEmissionSamples emission samples, and others get one. The choice is not random, so the numbers are
// independent of the samples.
template <class T>
void TileRenderer<T>::begin_emission_rays(const TileView& tile) {
  even_ = varied_ = LaneGroups();
  if (!tracer_->has_emission_pass()) return;
  find_streams(tile, SampleSet::emission_ray, emission_ray_streams_);
  const bool blurred = plan_.lens || plan_.shutter > 0;
  const Blocks varied = blurred ? Blocks{} : find_varied_blocks(tile);
  for (int i = 0; i < kBatch; i += kWidth<T>)
    (blurred || varied[static_cast<std::size_t>(i / 16)] ? varied_ : even_).add(i);
}

template <class T>
void TileRenderer<T>::trace_emission_only(const TileView& tile, int sample, PixelFilter::Part part,
                                          TraceResult<T>& into) {
  const auto trace = [&](int index, const LaneGroups& groups, T share) {
    place_samples(static_cast<std::uint32_t>(index), emission_ray_streams_, part, look_samples_);
    send_rays(tile, look_samples_, Draws(plan_.seed, tile, index), SampleSet::emission_ray_lens);
    tracer_->trace_emission_only(rays_, groups, share, into, stats_.counts);
  };
  if (!even_.empty()) trace(sample, even_, T(1));
  if (varied_.empty()) return;
  for (int k = 0; k < kMaxEmissionSamples; ++k)
    trace(kMaxEmissionSamples * sample + k, varied_, T(1) / T(kMaxEmissionSamples));
}

template <class T>
void TileRenderer<T>::find_streams(const TileView& tile, SampleSet set, Array<std::uint32_t>& streams) {
  const Draws draws(plan_.seed, tile, 0);
  const IndexLanes<float> lane([](int i) { return i; });
  for (int slot = 0; slot < kBatch; slot += kWidth<float>)
    draws.stream<float>(set, 0, lane + slot).copy_to(&streams[slot], stdx::vector_aligned);
}

template <class T>
void TileRenderer<T>::place_samples(std::uint32_t sample, const Array<std::uint32_t>& streams,
                                    PixelFilter::Part part, TileSamples& to) const {
  using Bits = Draws::Bits<float>;
  for (int slot = 0; slot < kBatch; slot += kWidth<float>) {
    const auto point = scrambled_point(Bits(sample), Bits(&streams[slot], stdx::vector_aligned));
    to.u.put(slot, point.u);
    to.v.put(slot, point.v);
  }
  if (filter_) filter_->place(part, to);
}

template <class T>
void TileRenderer<T>::add_sample() {
  const bool first = sums_.samples == 0;
  add_vector(first, result_.radiance, sums_.radiance);
  for (std::size_t c = 0; c < plan_.channels.size(); ++c) {
    const ChannelType& type = *plan_.channels[c];
    if (type.mean == ChannelMean::first_sample && !first) continue;
    const ChannelBatch<T>& from = result_.channels[c];
    TileSums::Sums& to = sums_.channels[c];
    const Array<T>* components[] = {&from.value.x, &from.value.y, &from.value.z};
    for (std::size_t k = 0; k < type.components.size(); ++k)
      add_weighted(first, *components[k], from.weight, to.value[k]);
    add(first, from.weight, to.weight);
  }
  ++sums_.samples;
}

template <class T>
void TileRenderer<T>::add_error(const TileHalves& halves) {
  stats_.error.add(halves.error());
  if (!std::isfinite(plan_.halves_range())) return;
  if (plan_.space == Space::display)
    halves.add_displayed_to(stats_.halves, plan_);
  else
    halves.add_to(stats_.halves, plan_);
}

template <class T>
void TileRenderer<T>::show_bound(const TileView& tile) {
  const double samples = sums_.samples;
  const bool halves = sums_.samples % 2 == 0;
  for_each_slot(tile, [&](std::size_t i) {
    double squares = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double left_out = omitted_.empty() ? 0 : omitted_[c][i];
      const double noise = halves ? std::fabs(2 * first_half_[c][i] - sums_.radiance[c][i]) : 0;
      squares += (left_out + noise) * (left_out + noise);
    }
    const Vec3d color = color_of_error(std::sqrt(squares / 3) / samples);
    for (std::size_t c = 0; c < 3; ++c) sums_.radiance[c][i] = color[c] * samples;
  });
}

template <class T>
void TileRenderer<T>::add_clamped(const TileView& tile) {
  stats_.clamped.pixels.add(ledger_of(tile, clamped_));
  std::array<double, 3> sums{};
  for (std::size_t c = 0; c < 3; ++c) for_each_slot(tile, [&](std::size_t i) { sums[c] += clamped_[c][i]; });
  stats_.clamped.add_tile(sums);
}

template <class T>
void TileRenderer<T>::add_to(RenderStats& stats) const {
  stats.counts.add(stats_.counts);
  stats.add(stats_);
}

template class TileRenderer<float>;
template class TileRenderer<double>;

}  // namespace orrery
