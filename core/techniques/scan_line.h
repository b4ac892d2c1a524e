#pragma once

#include "core/raster/tile_raster.h"
#include "core/techniques/specular_tree.h"

namespace orrery {

// Points at which scan line techniques evaluate light.
enum class ShadingPoints {
  triangles,  // the centroid of each triangle
  vertices,   // the vertices; colours are interpolated (Gouraud, "Continuous shading of curved surfaces",
              // 1971)
  pixels      // the samples; normals are interpolated (Phong, "Illumination for computer generated pictures",
              // 1975)
};

// Base of scan line techniques: a z-buffer finds the visible triangles of World::screen. Lighting is that of
// ray casting without shadows. Only visible triangles are shaded, tile by tile.
template <class T>
class ScanLine : public SpecularTree<T> {
 public:
  ScanLine(const World<T>& world, const Plan& plan, ShadingPoints points);
  void place(const TileView& tile, const TileSamples& samples) final;

 private:
  using N = Lanes<T>;
  static constexpr int kLanes = Facets::kLanes;
  using Narrow = stdx::rebind_simd_t<T, Facets::N>;  // kLanes numbers
  // Rays of a part of a register.
  struct Part {
    std::array<bool, kLanes> met{};
    std::array<int, kLanes>
        slots{};  // samples of these rays. The others have the sample of one of these rays
    bool empty = true;
  };

  void begin() final;
  LaneGroups find_vertices(const LaneGroups& groups) final;
  void shade_surfaces(const LaneGroups& met) final;
  void scatter(const LaneGroups& groups) final;

  // Finds the triangles behind transparent ones for the rays of the batch, and lights them as begin() does.
  void next_layer();
  // Continues rays behind transparent surfaces that do not refract, in the lanes of specular_.
  void follow_straight(int i);
  // Returns the sample of lane `lane` of the current batch.
  int slot_of(int lane) const {
    const PathBatch<T>& paths = *this->vertices_->paths;
    return paths.depth == 0 ? lane : static_cast<int>(paths.slot[lane]);
  }
  // Sets the radiance of rays `i` to `i` + kLanes - 1, if the colours of points are interpolated.
  void interpolate(int i, const Part& part);
  // Finds the distinct visible triangles of the tile, and evaluates light at their shading points.
  void shade_points();
  // Evaluates light at points_[first] to points_[last - 1].
  void shade_batch(std::size_t first, std::size_t last);
  // Returns which of the rays `i` to `i` + kLanes - 1 of the current batch meet a triangle.
  Part part_at(int i) const;
  Facets facets_of(const Facets::Numbers& triangles) const {
    return {screen_, this->plan_.frame, triangles, shading_ != ShadingPoints::triangles};
  }
  // Sets hits and surfaces of elements `i` to `i` + kLanes - 1 of the current batch: the points of the facets
  // with these weights. Sets t only where `met` is true.
  void put_surfaces(int i, const Facets& facets, const Facets::Weights& weights,
                    const std::array<bool, kLanes>& met);
  // Sets these elements of the rays of the current batch to rays of the camera to the points.
  void put_rays(int i, const Facets& facets, const Facets::Weights& weights);

  struct Point {
    std::uint32_t triangle;
    Vec3d weights;
    Vec3<T> radiance;
  };

  const Screen& screen_;
  const ShadingPoints shading_;
  const bool has_straight_;  // some material transmits without refraction
  TileRaster raster_;
  int layer_ = 0;  // depth of the rays for which raster_ has the triangles
  const TileView* tile_ = nullptr;
  const TileSamples* samples_ = nullptr;
  std::vector<std::uint64_t> visible_;  // triangle * kBatch + slot of each covered sample, ascending
  std::vector<Point> points_;           // one or three for each visible triangle
  Array<std::int32_t> point_of_;        // by slot: index in points_ of the first point of its triangle
  std::unique_ptr<PathBatch<T>> point_paths_;
};

extern template class ScanLine<float>;
extern template class ScanLine<double>;

}  // namespace orrery
