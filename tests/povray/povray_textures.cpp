#include "tests/povray/povray_scene.h"
#include "tests/povray/povray_text.h"

namespace orrery::povray {
namespace {

void require(bool holds, const std::string& what) {
  if (!holds) throw UnsupportedFeature("cannot export texture: " + what);
}

// Returns the transformation from POV-Ray's texture coordinates to the scene. The rows of a matrix are the
// images of the axes and of the origin.
std::string placement(const Json& mapping) {
  const std::string type = mapping.at("type");
  const Vec3d origin = vector_of(mapping, "origin", Vec3d(0));
  if (type == "solid") {
    require(!mapping.contains("axis"), "the axis of a solid texture must be y");
    return "scale " + text(mapping.value("size", 1.0)) + " translate " + text(origin) + " ";
  }
  if (type == "spherical") {  // angles run the other way
    require(!mapping.contains("axis"), "the axis of a spherical texture must be y");
    return "scale <1, 1, -1> translate " + text(origin) + " ";
  }
  require(type == "planar", "mapping must be solid, spherical or planar");
  const Vec3d u = vector_of(mapping, "u_edge", {1, 0, 0}), v = vector_of(mapping, "v_edge", {0, 1, 0});
  std::string rows;
  for (const Vec3d& row : {u, v, cross(u, v), origin})
    rows += (rows.empty() ? "" : ", ") + text(row.x) + ", " + text(row.y) + ", " + text(row.z);
  return "matrix <" + rows + "> ";
}

}  // namespace

std::string pigment_of(const Json& use, const Json& textures, const Vec3d& factor) {
  const Json& texture = textures.at(use.at("texture").get<std::string>());
  require(use.size() == 1, "scale, offset and channel must have their defaults");
  require(texture.value("filter", "pixel") == "none", "filter must be none");
  const std::string type = texture.at("type"), placed = placement(texture.at("mapping"));
  if (type == "checker")
    return "pigment { checker rgb " + text(coefficient_of(texture, "even", Vec3d(1)) * factor) + ", rgb " +
           text(coefficient_of(texture, "odd", Vec3d(0)) * factor) + " " + placed + "} ";
  require(type == "image", "type must be checker or image");
  require(factor == Vec3d(1), "colours that multiply an image must be white");
  const bool spherical = texture.at("mapping").at("type") == "spherical";
  return "pigment { image_map { png \"tests/povray/scenes/" + texture.at("file").get<std::string>() +
         "\" map_type " + (spherical ? "1" : "0") + " interpolate 2 } " + placed + "} ";
}

}  // namespace orrery::povray
