#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "tests/exact/shapes.h"

// Visibility of a scene's objects from its camera, decided in exact arithmetic. Parses the scene itself and
// shares no code with the renderer.
namespace orrery::exact {

class Oracle {
 public:
  // Requires a valid scene without motion and files.
  explicit Oracle(const nlohmann::json& scene);

  int width() const { return width_; }
  int height() const { return height_; }

  // Returns the number of the first object hit by the ray through the pixel's centre, or 0 if the ray misses.
  // Numbers start at 1 in the order of the scene, instances after objects. Ties go to the first by type
  // (sphere, plane, triangle, mesh, box, disk, cylinder), then by order in the scene. Instances come last.
  int object_at(int x, int y) const;

  // Returns true if rounding can make a renderer see `object` at the pixel. Rounding may move the ray's
  // origin across the ray, and the hit across and along the ray. Each move is at most `roundings` times
  // `epsilon` times the largest coordinate involved.
  bool explains(int x, int y, int object, double roundings, double epsilon) const;

 private:
  struct Item {
    Shape shape;
    int object;
    int placement = -1;  // index into placements_, or -1
  };
  struct Placement {
    IVec columns[3];      // in units of 2^-kFractionBits
    IVec translation;     // in the scene's units
    IVec rows[3];         // adjugate of the columns
    Integer determinant;  // determinant of the columns
    double size = 1;      // largest scale factor
  };
  struct Nearest {
    int object = 0;
    std::optional<Root> t;
  };

  // Scale of rounding errors at a pixel.
  struct Reach {
    double magnitude;  // largest coordinate of the ray and the objects involved, metres
    mpf_class t;       // ray parameter of the farther hit
    mpf_class speed;   // metres per unit of t
  };

  void read_camera(const nlohmann::json& camera);
  std::vector<Item> read_objects(const nlohmann::json& objects) const;
  Placement read_placement(const nlohmann::json& instance) const;
  Integer units(double x) const { return in_units(x, shift_); }
  IVec units(const nlohmann::json& v) const;

  Ray ray_at(int x, int y) const;
  Ray to_model(const Ray& ray, const Placement& placement) const;
  Ray seen_by(const Item& item, const Ray& ray) const;
  Nearest nearest(const Ray& ray) const;
  Reach reach(const Ray& ray, int object) const;
  // Returns 81 rays. The ray's origin and its point at `t` are each moved across the ray by `distance` metres
  // in one of eight directions, or not moved.
  std::vector<Ray> moved_rays(const Ray& ray, const mpf_class& t, double distance) const;

  int shift_;  // one scene unit is 2^-shift_ metres
  int width_, height_;
  bool parallel_ = false;
  IVec eye_, back_, right_, up_;  // unit directions times one common factor
  Integer scale_;                 // common factor of the three directions
  Integer extent_;                // half the image height, in scene units (orthographic) or 2^-kFractionBits
  std::vector<Item> items_;
  std::vector<Placement> placements_;
};

}  // namespace orrery::exact
