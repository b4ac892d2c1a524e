#pragma once

#include "core/model/record.h"
#include "core/model/texture.h"

namespace orrery {

// Texture whose formula is one record, `template <class N> struct Checker`, with
//   Vec3<N> value(const Vec3<N>& at, const Vec3<N>& width) const;   for scalars and lanes
//   TextureBounds bounds() const;                                   of Checker<double>
//   double detail() const;                                          of Checker<double>: see Texture
template <template <class> class Record>
class TextureOf final : public Texture {
 public:
  explicit TextureOf(const Record<double>& record) : record_(record) {}
  TextureBounds bounds() const override { return record_.bounds(); }
  double detail() const override { return record_.detail(); }
  TextureKernelPtr<float> kernel(float) const override { return std::make_unique<Kernel<float>>(record_); }
  TextureKernelPtr<double> kernel(double) const override { return std::make_unique<Kernel<double>>(record_); }

 private:
  template <class T>
  class Kernel final : public TextureKernel<T> {
   public:
    explicit Kernel(const Record<double>& record) : record_(convert_record<Record, T, double>(record)) {}
    void evaluate(const TexturePoints<T>& points, const LaneGroups& groups,
                  Vec3Array<T>& value) const override {
      const auto record = broadcast_record<Record, T>(record_);
      for (const int i : groups) value.put(i, record.value(points.at.at(i), points.width.at(i)));
    }

   private:
    Record<T> record_;
  };

  Record<double> record_;
};

// Returns the bounds of mixtures of two colours.
inline TextureBounds bounds_of_mix(const Vec3d& a, const Vec3d& b) {
  return {{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}, largest(a, b)};
}

// Returns a * (1 - share) + b * share, and exactly a if both are equal.
template <class N>
[[gnu::always_inline]] inline Vec3<N> mix_colors(const Vec3<N>& a, const Vec3<N>& b, const N& share) {
  return a + (b - a) * share;
}

}  // namespace orrery
