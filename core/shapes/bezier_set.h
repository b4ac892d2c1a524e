#pragma once

#include "core/shapes/bezier_kernel.h"

namespace orrery {

// Maximum number of coefficients of all pieces of a scene or a model.
inline constexpr std::size_t kMaxBezierCoefficients = std::size_t{1} << 23;

// Shapes made of rational Bezier patches. `read` appends the patches of one object. Each patch is halved
// until it is nearly flat. The pieces are the primitives.
class BezierSet final : public ShapeSet {
 public:
  using Read = void (*)(Params&, std::vector<BezierPatch>&);
  explicit BezierSet(Read read) : read_(read) {}

  int add(Params& params, MeshSource& meshes) override;
  int size() const override { return static_cast<int>(pieces_.size()); }
  Boundsd bounds(int index) const override;
  ShapeTraits traits() const override { return {.convex = false, .closed = false}; }
  void tessellate(const TessellationView& view, int first, Tessellation& out) const override;
  ShapeKernelPtr<float> kernel(float, int first) const override { return make<float>(first); }
  ShapeKernelPtr<double> kernel(double, int first) const override { return make<double>(first); }
  ShapeKernelPtr<long double> kernel(long double, int first) const override {
    return make<long double>(first);
  }

 private:
  // Patches and pieces of one object.
  struct Object {
    std::vector<BezierPatch> patches;
    std::size_t first_piece;
    double magnitude;  // largest absolute coordinate of the control points
  };

  // Adds the pieces of a patch of an object. Returns false if the scene has too many.
  bool add_pieces(const BezierPatch& patch, double magnitude);
  template <class T>
  ShapeKernelPtr<T> make(int first) const;

  Read read_;
  std::vector<Object> objects_;
  std::vector<BezierPatch> pieces_;
  std::size_t coefficients_ = 0;
};

// Returns the patch with `origin` moved to the centre of the control points' box.
BezierPatch centered(BezierPatch patch);

}  // namespace orrery
