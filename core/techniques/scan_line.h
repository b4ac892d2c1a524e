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
  using Weights = Vec3d;  // one for each corner of a triangle

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
  // Finds the distinct visible triangles of the tile, and evaluates light at their shading points.
  void shade_points();
  // Evaluates light at points_[first] to points_[last - 1].
  void shade_batch(std::size_t first, std::size_t last);
  // Sets hit and surface of element i of the current batch: the point of facet_ with these weights.
  void put_surface(int i, const Weights& weights, const Ray<T>& ray);
  // Returns the ray of the camera to the point of facet_ with these weights.
  Ray<T> ray_to(const Weights& weights) const;
  // Sets facet_.
  void use_facet(std::uint32_t triangle);

  struct Point {
    std::uint32_t triangle;
    Weights weights;
    Vec3<T> radiance;
  };
  // Triangle with data that all of its points share.
  struct Facet {
    std::uint32_t triangle = std::numeric_limits<std::uint32_t>::max();
    std::int32_t primitive;
    std::array<Vec3d, 3> positions, normals;
    Vec3d face;   // outward unit normal of the triangle
    double side;  // SurfaceBatch::side
  };

  const Screen& screen_;
  const ShadingPoints shading_;
  const bool has_straight_;  // some material transmits without refraction
  TileRaster raster_;
  int layer_ = 0;  // depth of the rays for which raster_ has the triangles
  const TileView* tile_ = nullptr;
  const TileSamples* samples_ = nullptr;
  Facet facet_;
  std::vector<std::uint64_t> visible_;  // triangle * kBatch + slot of each covered sample, ascending
  std::vector<Point> points_;           // one or three for each visible triangle
  Array<std::int32_t> point_of_;        // by slot: index in points_ of the first point of its triangle
  std::unique_ptr<PathBatch<T>> point_paths_;
};

extern template class ScanLine<float>;
extern template class ScanLine<double>;

}  // namespace orrery
