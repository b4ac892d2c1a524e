#include "tests/exact/random_scenes.h"

#include <cmath>

namespace orrery::test {
namespace {

using nlohmann::json;

json list(const Vec3d& v) { return {v.x, v.y, v.z}; }

json sphere(const Vec3d& center, double radius) {
  return {{"type", "sphere"}, {"center", list(center)}, {"radius", radius}};
}
json box(const Vec3d& lo, const Vec3d& hi) { return {{"type", "box"}, {"min", list(lo)}, {"max", list(hi)}}; }
json disk(const Vec3d& center, const Vec3d& normal, double radius) {
  return {{"type", "disk"}, {"center", list(center)}, {"normal", list(normal)}, {"radius", radius}};
}
json tube(const Vec3d& base, const Vec3d& top, double radius) {
  return {{"type", "cylinder"}, {"base", list(base)}, {"top", list(top)}, {"radius", radius}};
}
json column(const Vec3d& point, const Vec3d& axis, double radius) {
  return {{"type", "cylinder"}, {"point", list(point)}, {"axis", list(axis)}, {"radius", radius}};
}
json plane(const Vec3d& point, const Vec3d& normal) {
  return {{"type", "plane"}, {"point", list(point)}, {"normal", list(normal)}};
}
json triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return {{"type", "triangle"}, {"vertices", {list(a), list(b), list(c)}}};
}

json tetrahedron(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  return {{"type", "mesh"},
          {"positions", {list(a), list(b), list(c), list(d)}},
          {"indices", {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}}};
}

// Returns a random shape of about size `size` near `at`.
json any_shape(Random& random, const Vec3d& at, double size) {
  const Vec3d a = at + random.in_cube(size), b = at + random.in_cube(size), c = at + random.in_cube(size);
  switch (random.below(8)) {
    case 0: return sphere(a, size * random.between(0.1, 1));
    case 1: return plane(a, random.direction());
    case 2: return triangle(a, b, c);
    case 3: {
      const Vec3d half(size * random.between(0.1, 1), size * random.between(0.1, 1),
                       size * random.between(0.1, 1));
      return box(a - half, a + half);
    }
    case 4: return disk(a, random.direction(), size * random.between(0.1, 1));
    case 5: return tube(a, b, size * random.between(0.05, 0.5));
    case 6: return column(a, random.direction(), size * random.between(0.02, 0.2));
    default: return tetrahedron(a, b, c, at + random.in_cube(size));
  }
}

json scene(json objects, const Vec3d& eye, const Vec3d& look_at, double fov_degrees) {
  for (json& object : objects) object["material"] = "white";
  return {{"version", 1},
          {"camera",
           {{"type", "perspective"},
            {"eye", list(eye)},
            {"look_at", list(look_at)},
            {"fov_degrees", fov_degrees}}},
          {"materials", {{"white", {{"type", "rough"}}}}},
          {"objects", std::move(objects)}};
}
json parallel(json scene, double height) {
  scene["camera"].erase("fov_degrees");
  scene["camera"]["type"] = "orthographic";
  scene["camera"]["height"] = height;
  return scene;
}

json cloud(Random& random, const Vec3d& at, double size, int count) {
  json objects = json::array();
  for (int i = 0; i < count; ++i) objects.push_back(any_shape(random, at, size));
  return objects;
}

json mixed(Random& random) {
  return scene(cloud(random, Vec3d(0), 1, 12), random.direction() * random.between(0.2, 4), Vec3d(0), 45);
}

// Returns nested shapes, seen from outside or inside.
json nested(Random& random) {
  json objects = json::array();
  double size = 1;
  for (int i = 0; i < 10; ++i, size *= 1 - random.magnitude(1e-7, 0.3)) {
    const Vec3d half(size), axis = random.direction() * size;
    const int kind = random.below(3);
    objects.push_back(kind == 0   ? sphere(Vec3d(0), size)
                      : kind == 1 ? box(-half, half)
                                  : tube(-axis, axis, size));
  }
  return scene(objects, random.direction() * random.between(0.1, 4), random.in_cube(0.1), 50);
}

// Returns shapes whose faces, rims or curved surfaces touch.
json touching(Random& random) {
  json objects = json::array();
  const double side = random.between(0.3, 0.6);
  for (int i = -1; i <= 1; ++i)
    for (int k = -1; k <= 1; ++k) {
      const Vec3d lo(i * side, 0, k * side);
      const int kind = random.below(4);
      if (kind == 0) objects.push_back(box(lo, lo + Vec3d(side)));
      if (kind == 1) objects.push_back(sphere(lo + Vec3d(side / 2), side / 2));
      if (kind == 2)
        objects.push_back(
            tube(lo + Vec3d(side / 2, 0, side / 2), lo + Vec3d(side / 2, side, side / 2), side / 2));
      if (kind == 3) {
        objects.push_back(triangle(lo, lo + Vec3d(side, 0, 0), lo + Vec3d(side, side, side)));
        objects.push_back(triangle(lo, lo + Vec3d(side, side, side), lo + Vec3d(0, 0, side)));
      }
    }
  objects.push_back(plane(Vec3d(0), Vec3d(0, 1, 0)));
  objects.push_back(disk(Vec3d(0), Vec3d(0, 1, 0), 2 * side));
  return scene(objects, random.direction_above(Vec3d(0, 1, 0)) * 3 + Vec3d(0, 0.01, 0), Vec3d(0), 45);
}

// Returns shapes with integer coordinates, seen along an axis so that pixel centres fall on edges, vertices
// and rims.
json lattice(Random& random) {
  json objects = json::array();
  const auto node = [&] { return Vec3d(random.below(9) - 4, random.below(9) - 4, random.below(5) - 2); };
  while (objects.size() < 14) {
    const Vec3d a = node(), b = node(), c = node();
    const int kind = random.below(6);
    if (kind == 0) objects.push_back(sphere(a, 1 + random.below(2)));
    if (kind == 1) objects.push_back(box(a, a + Vec3d(1 + random.below(3), 1 + random.below(3), 1)));
    if (kind == 2 && length(cross(b - a, c - a)) > 0) objects.push_back(triangle(a, b, c));
    if (kind == 3) objects.push_back(disk(a, Vec3d(0, 0, 1), 1 + random.below(3)));
    if (kind == 4) objects.push_back(tube(a, a + Vec3d(0, 0, 1 + random.below(2)), 1 + random.below(2)));
    if (kind == 5 && length(cross(b - a, c - a)) > 0)
      objects.push_back(tetrahedron(a, b, c, a + cross(b - a, c - a)));
  }
  // A pixel is 0.5 m wide (24 rows in 12 m). The offset of half a pixel moves pixel centres to multiples of
  // 0.5 m.
  return parallel(scene(objects, Vec3d(0.25, 0.25, 8), Vec3d(0.25, 0.25, 0), 45), 12);
}

// Returns surfaces nearly parallel to the view direction.
json grazing(Random& random) {
  json objects = json::array();
  const Vec3d eye(0, 0, 4);
  for (int i = 0; i < 10; ++i) {
    const double tilt = random.magnitude(1e-9, 0.1), angle = random.between(0, 6.28);
    const Vec3d side(std::cos(angle), std::sin(angle), 0);
    const Vec3d at = side * random.between(0, 1) + Vec3d(0, 0, random.between(-2, 2));
    const Vec3d normal = side + Vec3d(0, 0, tilt);
    const int kind = random.below(4);
    if (kind == 0) objects.push_back(disk(at, normal, 1));
    if (kind == 1) objects.push_back(plane(at, normal));
    if (kind == 2)
      objects.push_back(column(at, Vec3d(side.x * tilt, side.y * tilt, 1), random.between(0.05, 0.3)));
    if (kind == 3) objects.push_back(sphere(side * (4 + tilt), 4));
  }
  return scene(objects, eye, Vec3d(0), 40);
}

json needles(Random& random) {
  json objects = json::array();
  for (int i = 0; i < 24; ++i) {
    const Vec3d a = random.in_cube(1), b = random.in_cube(1);
    objects.push_back(triangle(a, b, (a + b) * 0.5 + random.direction() * random.magnitude(1e-7, 0.1)));
  }
  return scene(objects, random.direction() * 3, Vec3d(0), 45);
}

json placed_cloud(Random& random, const Vec3d& at, double size) {
  return scene(cloud(random, at, size, 12), at + random.direction() * (3 * size), at, 45);
}
json far_away(Random& random) {
  return placed_cloud(random, random.direction() * random.magnitude(1e2, 1e6), 1);
}
json tiny(Random& random) { return placed_cloud(random, Vec3d(0), random.magnitude(1e-10, 1e-3)); }
json huge(Random& random) { return placed_cloud(random, Vec3d(0), random.magnitude(1e3, 1e9)); }

// Returns a narrow view of a corner or a rim.
json telescopic(Random& random) {
  const Vec3d corner = random.in_cube(1), up = random.direction(), right = perpendicular(up);
  const double size = random.between(0.2, 1);
  json objects = json::array();
  switch (random.below(4)) {
    case 0: objects.push_back(box(corner - Vec3d(size), corner)); break;
    case 1: objects.push_back(disk(corner - right * size, up, size)); break;
    case 2: objects.push_back(tube(corner - right * size, corner - right * size + up, size)); break;
    default:
      for (int i = 0; i < 5; ++i)
        objects.push_back(triangle(corner, corner + random.direction(), corner + random.direction()));
  }
  return scene(objects, corner + random.direction() * 5, corner, random.magnitude(1e-4, 1));
}

json instances(Random& random) {
  json scene = mixed(random);
  json objects = scene["objects"];
  for (std::size_t i = 0; i < objects.size();)
    if (objects[i]["type"] == "plane" || objects[i].contains("axis"))
      objects.erase(i);
    else
      ++i;
  if (objects.empty()) return mixed(random);
  scene["models"]["it"]["objects"] = objects;
  scene["objects"] = json::array();
  for (int i = 0; i < 5; ++i) {
    const auto factor = [&] { return random.magnitude(0.2, 3) * (random.below(4) == 0 ? -1 : 1); };
    json instance = {{"model", "it"}, {"translate", list(random.in_cube(1))}};
    if (random.below(3) > 0)
      instance["rotate"] = {{"axis", list(random.direction())}, {"degrees", random.between(-400, 400)}};
    if (random.below(3) > 0) instance["scale"] = {factor(), factor(), factor()};
    scene["instances"].push_back(instance);
  }
  return scene;
}

}  // namespace

const std::vector<SceneClass>& scene_classes() {
  static const std::vector<SceneClass> classes{
      {"mixed", mixed},     {"nested", nested},         {"touching", touching},  {"lattice", lattice},
      {"grazing", grazing}, {"needles", needles},       {"far", far_away},       {"tiny", tiny},
      {"huge", huge},       {"telescopic", telescopic}, {"instances", instances}};
  return classes;
}

}  // namespace orrery::test
