#include "core/math/affine.h"
#include "core/math/hemisphere.h"
#include "tests/povray/povray_scene.h"
#include "tests/povray/povray_text.h"

namespace orrery::povray {
namespace {

std::string plane(const Json& o) {
  const Vec3d normal = normalize(vector_of(o, "normal"));
  return "plane { " + text(normal) + ", " + text(dot(normal, vector_of(o, "point"))) + " ";
}

std::string triangle(const Json& o) {
  const Json& v = o.at("vertices");
  return "triangle { " + text(vector_of(v[0])) + ", " + text(vector_of(v[1])) + ", " + text(vector_of(v[2])) +
         " ";
}

std::string list(const char* name, const Json& triples) {
  std::string out = std::string(name) + " { " + std::to_string(triples.size());
  for (const Json& triple : triples) out += ",\n    " + text(vector_of(triple));
  return out + " }\n";
}

std::string mesh(const Json& o) {
  std::string out = "mesh2 {\n  " + list("vertex_vectors", o.at("positions"));
  if (o.contains("normals") && !o.at("normals").empty())
    out += "  " + list("normal_vectors", o.at("normals"));
  return out + "  " + list("face_indices", o.at("indices"));
}

// |p - c|^2 - ((p - c) . a)^2 = r^2 as a quadric: the matrix is M = 1 - a a^T.
std::string infinite_cylinder(const Json& o) {
  const Vec3d c = vector_of(o, "point"), a = normalize(vector_of(o, "axis"));
  const double radius = o.at("radius");
  const Vec3d squares(1 - a.x * a.x, 1 - a.y * a.y, 1 - a.z * a.z);
  const Vec3d products(-2 * a.x * a.y, -2 * a.x * a.z, -2 * a.y * a.z);
  const Vec3d across = c - a * dot(c, a);  // M c
  return "quadric { " + text(squares) + ", " + text(products) + ", " + text(across * -2.0) + ", " +
         text(dot(c, across) - radius * radius) + " ";
}

std::string cylinder(const Json& o) {
  if (o.contains("axis")) return infinite_cylinder(o);
  return "cylinder { " + text(vector_of(o, "base")) + ", " + text(vector_of(o, "top")) + ", " +
         text(o.at("radius").get<double>()) + " ";
}

std::string cone(const Json& o) {
  return "cone { " + text(vector_of(o, "base")) + ", " + text(o.at("base_radius").get<double>()) + ", " +
         text(vector_of(o, "top")) + ", " + text(o.value("top_radius", 0.0)) + " ";
}

// A torus of POV-Ray lies around the y axis. The rows of the matrix are the images of the axes and of the
// origin.
std::string torus(const Json& o) {
  const Vec3d axis = normalize(vector_of(o, "axis"));
  const Tangents<double> across = tangents_of(axis);
  std::string rows;
  for (const Vec3d& row : {across.first, axis, across.second, vector_of(o, "center")})
    rows += (rows.empty() ? "" : ", ") + text(row.x) + ", " + text(row.y) + ", " + text(row.z);
  return "torus { " + text(o.at("major_radius").get<double>()) + ", " +
         text(o.at("minor_radius").get<double>()) + " sturm matrix <" + rows + "> ";
}

// POV-Ray divides each patch into 64 x 64 pairs of triangles with interpolated normals.
std::string bicubic_patches(const Json& o) {
  const Json& points = o.at("points");
  if (o.value("degree_u", 3) != 3 || o.value("degree_v", 3) != 3 || o.contains("weights"))
    throw UnsupportedFeature("cannot export patches of other degrees or with weights");
  std::string out = "union {\n";
  for (std::size_t first = 0; first < points.size(); first += 16) {
    out += "  bicubic_patch { type 1 flatness 0 u_steps 6 v_steps 6";
    for (std::size_t i = first; i < first + 16; ++i) out += ", " + text(vector_of(points[i]));
    out += " }\n";
  }
  return out;
}

}  // namespace

std::string placement_of(const Json& o) {
  const Json turn = o.value("rotate", Json::object());
  const Affined rotated =
      rotation(safe_normalize(vector_of(turn, "axis", Vec3d(0, 1, 0))), turn.value("degrees", 0.0));
  const Vec3d scale = vector_of(o, "scale", Vec3d(1)), move = vector_of(o, "translate", Vec3d(0));
  std::string rows;
  for (const Vec3d& row : {rotated.x * scale.x, rotated.y * scale.y, rotated.z * scale.z, move})
    rows += (rows.empty() ? "" : ", ") + text(row.x) + ", " + text(row.y) + ", " + text(row.z);
  return "matrix <" + rows + "> ";
}

std::string shape_of(const Json& o) {
  const std::string type = o.at("type");
  if (type == "sphere")
    return "sphere { " + text(vector_of(o, "center")) + ", " + text(o.at("radius").get<double>()) + " ";
  if (type == "box") return "box { " + text(vector_of(o, "min")) + ", " + text(vector_of(o, "max")) + " ";
  if (type == "disk")
    return "disc { " + text(vector_of(o, "center")) + ", " + text(vector_of(o, "normal")) + ", " +
           text(o.at("radius").get<double>()) + " ";
  if (type == "plane") return plane(o);
  if (type == "triangle") return triangle(o);
  if (type == "mesh") return mesh(o);
  if (type == "cylinder") return cylinder(o);
  if (type == "cone") return cone(o);
  if (type == "torus") return torus(o);
  if (type == "patch") return bicubic_patches(o);
  throw UnsupportedFeature("cannot export shape of type " + type);
}

}  // namespace orrery::povray
