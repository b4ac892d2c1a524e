#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/environments/importance_table.h"
#include "core/image/decode/picture.h"
#include "core/math/elementary.h"
#include "core/math/vec3.h"

namespace orrery {

// Equirectangular radiance map. Its centre is toward -z, its top toward +y, its right half toward +x.
// Radiance is interpolated bilinearly between texel centres.
//
// The sampling density is interpolated bilinearly between the same centres: draw() selects a texel with a
// probability proportional to its weight, then a point of the texel's tent filter. Weights are luminance
// times the sine of the angle from +y.
class LightMap {
 public:
  // Texel weights. `compensated` subtracts the mean luminance over all directions and clamps at 0, because
  // BSDF sampling covers the darker texels (Karlik, Sik, Vevoda, Skrivan, Krivanek, "MIS Compensation",
  // SIGGRAPH Asia 2019).
  enum class Weights { plain, compensated };
  explicit LightMap(const Texels& picture, Weights weights = Weights::compensated);

  // Returns whether any texel has a positive weight. With compensated weights, false for uniform light.
  bool sampled() const { return !table_.empty(); }

  // Map coordinates of a direction, in texels from the left and from the top.
  template <class N>
  struct Place {
    N x, y;
  };
  // REQUIRES: direction is not 0.
  template <class N>
  Place<N> place_of(const Vec3<N>& direction) const {
    using T = ScalarOf<N>;
    using std::sqrt;
    const N across = sqrt(direction.x * direction.x + direction.z * direction.z);
    const N turns = direction_turns(N(-direction.z), direction.x),
            down = direction_turns(direction.y, across);
    return {(turns + T(0.5)) * T(table_.width()), down * T(2 * table_.height())};
  }
  template <class N>
  struct Direction {
    Vec3<N> toward;  // unit
    N sine;          // sine of the angle from +y
  };
  template <class N>
  Direction<N> direction_of(const Place<N>& place) const {
    using T = ScalarOf<N>;
    const auto across = sine_cosine_turns(N(place.x * (T(1) / T(table_.width())) - T(0.5)));
    const auto down = sine_cosine_turns(N(place.y * (T(0.5) / T(table_.height()))));
    return {{down.sine * across.sine, down.cosine, -down.sine * across.cosine}, down.sine};
  }

  // Radiance at a place, and the sampling density of draw() at the place.
  template <class T>
  struct Value {
    Vec3<T> radiance;
    T by_texel;  // pdf per solid angle is by_texel * density_factor() / sine
  };
  template <class T>
  Value<T> at(T x, T y) const;
  Vec3d most() const;  // maximum radiance, per channel
  double density_factor() const {
    return table_.width() * (table_.height() / (2 * std::numbers::pi * std::numbers::pi));
  }

  // Samples a place: u and v select a texel, `along` and `down` a point of its tent. All four are in [0, 1),
  // and u and v are multiples of 2^-24. REQUIRES: sampled().
  template <class T>
  Place<T> draw(T u, T v, T along, T down) const;

 private:
  struct Texel {
    float red, green, blue, probability;
  };
  const Texel& texel(int column, int row) const {
    return texels_[static_cast<std::size_t>(row) * static_cast<std::size_t>(table_.width()) +
                   static_cast<std::size_t>(column)];
  }

  ImportanceTable table_;
  std::vector<Texel> texels_;
};

template <class T>
LightMap::Value<T> LightMap::at(T x, T y) const {
  const int width = table_.width(), last = table_.height() - 1;
  const T left = std::floor(x - T(0.5)), top = std::floor(y - T(0.5));
  const T s = x - T(0.5) - left, t = y - T(0.5) - top;
  const int a = static_cast<int>(left), c = static_cast<int>(top);
  const auto column = [&](int i) { return i < 0 ? i + width : i >= width ? i - width : i; };
  const auto row = [&](int j) { return std::clamp(j, 0, last); };
  Value<T> sum{};
  const auto add = [&](int i, int j, T share) {
    const Texel& texel = this->texel(column(i), row(j));
    sum.radiance = sum.radiance + Vec3<T>(T(texel.red), T(texel.green), T(texel.blue)) * share;
    sum.by_texel += T(texel.probability) * share;
  };
  add(a, c, (1 - s) * (1 - t));
  add(a + 1, c, s * (1 - t));
  add(a, c + 1, (1 - s) * t);
  add(a + 1, c + 1, s * t);
  return sum;
}

template <class T>
LightMap::Place<T> LightMap::draw(T u, T v, T along, T down) const {
  // Samples a tent of width 2, centred at 0.
  const auto tent = [](T share) {
    return share < T(0.5) ? std::sqrt(2 * share) - 1 : 1 - std::sqrt(2 * (1 - share));
  };
  const ImportanceTable::Cell cell = table_.draw(double{u}, double{v});
  const T width = T(table_.width()), height = T(table_.height());
  T x = T(cell.column) + T(0.5) + tent(along), y = T(cell.row) + T(0.5) + tent(down);
  x = x < 0 ? x + width : x >= width ? x - width : x;
  y = y < 0 ? -y : y > height ? 2 * height - y : y;  // tents at the poles are reflected back into the map
  return {x, y};
}

}  // namespace orrery
