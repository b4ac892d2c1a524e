#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "tests/exact/shapes.h"

// What a scene's camera sees, decided in exact arithmetic. It reads the scene itself and shares no code with
// the renderer.
namespace orrery::exact {

class Oracle {
 public:
  // Of a valid scene without motion and files.
  explicit Oracle(const nlohmann::json& scene);

  int width() const { return width_; }
  int height() const { return height_; }

  // The number of the object that the ray through the pixel's centre meets first, from 1 as the scene lists
  // them (instances follow the objects); 0 is nothing. Of equally near ones the first: in the order of types
  // sphere, plane, triangle, mesh, box, disk, cylinder, then as listed, then instances.
  int object_at(int x, int y) const;

  // Whether rounding explains that a renderer sees `object` there: positions move by at most `roundings`
  // times `epsilon` times the largest coordinate in play, across the ray at its origin and at the hit, and
  // along it.
  bool explains(int x, int y, int object, double roundings, double epsilon) const;

 private:
  struct Item {
    Shape shape;
    int object;
    int placement = -1;  // of placements_
  };
  struct Placement {
    IVec columns[3];      // in units of 2^-kFractionBits of the scene's
    IVec translation;     // in the scene's units
    IVec rows[3];         // of the adjugate of the columns
    Integer determinant;  // of the columns
    double size = 1;      // largest factor
  };
  struct Nearest {
    int object = 0;
    std::optional<Root> t;
  };

  // What rounding at a pixel is relative to.
  struct Reach {
    double magnitude;  // metres: the largest coordinate of the ray and of the objects in play
    mpf_class t;       // of the farther of their hits
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
  // Rays whose origins and points at `t` are moved across by `distance` metres, in eight directions each, or
  // stay.
  std::vector<Ray> moved_rays(const Ray& ray, const mpf_class& t, double distance) const;

  int shift_;  // the scene's units are 2^-shift_ metres
  int width_, height_;
  bool parallel_ = false;
  IVec eye_, back_, right_, up_;  // scaled alike: unit directions times one factor
  Integer scale_;                 // that factor
  Integer extent_;  // half the picture's height: units of 2^-kFractionBits, or the scene's units
  std::vector<Item> items_;
  std::vector<Placement> placements_;
};

}  // namespace orrery::exact
