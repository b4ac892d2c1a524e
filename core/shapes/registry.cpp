#include "core/shapes/registry.h"

#include <array>

namespace orrery {

using MakeShapes = std::unique_ptr<ShapeSet>();
MakeShapes make_boxes, make_cylinders, make_disks, make_meshes, make_planes, make_spheres, make_triangles;

std::span<const ShapeType> shape_types() {
  static constexpr std::array kTypes{
      ShapeType{"sphere", "Points at one distance from a centre.", make_spheres},
      ShapeType{"plane", "An infinite flat surface.", make_planes},
      ShapeType{"triangle", "Three vertices and the flat surface between them.", make_triangles},
      ShapeType{"mesh", "Triangles over shared vertices, watertight along shared edges.", make_meshes},
      ShapeType{"box", "A box along the axes.", make_boxes},
      ShapeType{"disk", "A flat round plate.", make_disks},
      ShapeType{"cylinder", "A round column, with caps or infinitely long.", make_cylinders},
  };
  return kTypes;
}

}  // namespace orrery
