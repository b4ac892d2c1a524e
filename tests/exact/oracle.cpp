#include "tests/exact/oracle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "tests/exact/angles.h"

namespace orrery::exact {
namespace {

using nlohmann::json;

constexpr int kFloatBits = 2048;  // precision of approximate distances between hits

int finest_bit(const json& value) {
  if (value.is_number()) return bits_below_one(value.get<double>());
  int finest = 0;
  if (value.is_structured())
    for (const auto& member : value) finest = std::max(finest, finest_bit(member));
  return finest;
}

double largest(const json& v) {
  double size = 0;
  for (const auto& x : v) size = std::max(size, std::abs(x.get<double>()));
  return size;
}

mpf_class real(const Integer& i) { return mpf_class(i, kFloatBits); }
mpf_class real(const Root& t) { return (real(t.p) + t.s * sqrt(real(t.d))) / real(t.q); }

}  // namespace

Oracle::Oracle(const json& scene)
    : shift_(finest_bit(scene) + 1),
      width_(scene.at("image").at("width")),
      height_(scene.at("image").at("height")) {
  read_camera(scene.at("camera"));
  items_ = read_objects(scene.value("objects", json::array()));
  std::map<std::string, std::vector<Item>> models;
  if (scene.contains("models"))
    for (const auto& [name, model] : scene["models"].items())
      models[name] = read_objects(model.at("objects"));
  int object = static_cast<int>(scene.value("objects", json::array()).size());
  for (const json& instance : scene.value("instances", json::array())) {
    placements_.push_back(read_placement(instance));
    const double moved = largest(instance.value("translate", json::array({0, 0, 0})));
    ++object;
    for (Item item : models.at(instance.at("model"))) {
      item.object = object;
      item.placement = static_cast<int>(placements_.size()) - 1;
      item.shape.reach = item.shape.reach * placements_.back().size + moved;
      items_.push_back(item);
    }
  }
}

IVec Oracle::units(const json& v) const {
  return {units(v.at(0).get<double>()), units(v.at(1).get<double>()), units(v.at(2).get<double>())};
}

void Oracle::read_camera(const json& camera) {
  eye_ = units(camera.at("eye"));
  const IVec back = eye_ - units(camera.at("look_at"));
  const IVec right = cross(units(camera.value("up", json::array({0, 1, 0}))), back);
  const Integer along = length(back), across = length(right);
  back_ = back * (across * kOne);
  right_ = right * (along * kOne);
  up_ = cross(back, right) * (kOne * kOne);
  scale_ = along * across;
  parallel_ = camera.at("type") == "orthographic";
  if (parallel_) {
    extent_ = units(camera.at("height").get<double>() / 2);
  } else {
    const ExactRotation half = turn(camera.value("fov_degrees", 45.0) / 2);
    extent_ = half.sine * kOne / half.cosine;
  }
}

std::vector<Oracle::Item> Oracle::read_objects(const json& objects) const {
  std::vector<Item> items;
  int object = 0;
  const auto read = [&](const json& o, const std::string& type) {
    const auto add = [&](Shape::Kind kind, const IVec& a, const IVec& b, const IVec& c, double reach) {
      const double radius = o.value("radius", 0.0);
      items.push_back({{kind, a, b, c, units(radius), reach + radius}, object});
    };
    const auto reach = [&](const char* a, const char* b) {
      return std::max(largest(o.at(a)), largest(o.at(b)));
    };
    if (type == "sphere")
      add(Shape::Kind::sphere, units(o["center"]), {}, {}, largest(o["center"]));
    else if (type == "plane")
      add(Shape::Kind::plane, units(o["point"]), units(o["normal"]), {}, largest(o["point"]));
    else if (type == "triangle")
      add(Shape::Kind::triangle, units(o["vertices"][0]), units(o["vertices"][1]), units(o["vertices"][2]),
          std::max({largest(o["vertices"][0]), largest(o["vertices"][1]), largest(o["vertices"][2])}));
    else if (type == "mesh")
      for (const json& corners : o["indices"]) {
        const auto at = [&](int i) { return o["positions"][corners[i].get<std::size_t>()]; };
        add(Shape::Kind::triangle, units(at(0)), units(at(1)), units(at(2)),
            std::max({largest(at(0)), largest(at(1)), largest(at(2))}));
      }
    else if (type == "box")
      add(Shape::Kind::box, units(o["min"]), units(o["max"]), {}, reach("min", "max"));
    else if (type == "disk")
      add(Shape::Kind::disk, units(o["center"]), units(o["normal"]), {}, largest(o["center"]));
    else if (o.contains("base"))
      add(Shape::Kind::cylinder, units(o["base"]), units(o["top"]), {}, reach("base", "top"));
    else
      add(Shape::Kind::infinite_cylinder, units(o["point"]), units(o["axis"]), {}, largest(o["point"]));
  };
  for (const char* type : {"sphere", "plane", "triangle", "mesh", "box", "disk", "cylinder"}) {
    object = 0;
    for (const json& o : objects) {
      ++object;
      if (o.at("type") == type) read(o, type);
    }
  }
  return items;
}

Oracle::Placement Oracle::read_placement(const json& instance) const {
  const json rotate = instance.value("rotate", json::object());
  const IVec axis = units(rotate.value("axis", json::array({0, 1, 0})));
  const ExactRotation angle = turn(rotate.value("degrees", 0.0));
  const IVec scale = units(instance.value("scale", json::array({1, 1, 1})));
  const Integer size = length(axis);
  const auto unit = [&](int i) { return Integer(axis[i] * kOne * kOne / size); };
  const Integer u[3] = {unit(0), unit(1), unit(2)};
  const auto entry = [&](int i, int k) {  // row i, column k, in units of 2^-kFractionBits
    const Integer both = (kOne - angle.cosine) * u[i] * u[k] / (kOne * kOne);
    if (i == k) return Integer(both + angle.cosine);
    const Integer turned = angle.sine * u[3 - i - k] / kOne;
    return (k - i + 3) % 3 == 1 ? Integer(both - turned) : Integer(both + turned);
  };
  Placement p;
  for (int k = 0; k < 3; ++k) p.columns[k] = IVec{entry(0, k), entry(1, k), entry(2, k)} * scale[k];
  p.translation = units(instance.value("translate", json::array({0, 0, 0})));
  for (int k = 0; k < 3; ++k) p.rows[k] = cross(p.columns[(k + 1) % 3], p.columns[(k + 2) % 3]);
  p.determinant = dot(p.columns[0], p.rows[0]);
  p.size = largest(instance.value("scale", json::array({1, 1, 1})));
  return p;
}

Ray Oracle::ray_at(int x, int y) const {
  const Integer kx = 2 * x + 1 - width_, ky = height_ - 2 * y - 1, h = height_;
  const IVec offset = right_ * (kx * extent_) + up_ * (ky * extent_);
  if (!parallel_) return {eye_, 1, offset - back_ * (h * kOne)};
  return {eye_ * (scale_ * h) + offset, scale_ * h, back_ * Integer(-1)};
}

Ray Oracle::to_model(const Ray& ray, const Placement& placement) const {
  const Integer unit = (kOne << static_cast<unsigned>(shift_)) * sgn(placement.determinant);
  const auto solve = [&](const IVec& v) {
    return IVec{dot(placement.rows[0], v), dot(placement.rows[1], v), dot(placement.rows[2], v)} * unit;
  };
  return {solve(ray.origin - placement.translation * ray.w), ray.w * abs(placement.determinant),
          solve(ray.direction)};
}

Ray Oracle::seen_by(const Item& item, const Ray& ray) const {
  return item.placement < 0 ? ray : to_model(ray, placements_[static_cast<std::size_t>(item.placement)]);
}

Oracle::Nearest Oracle::nearest(const Ray& ray) const {
  Nearest found;
  for (const Item& item : items_) {
    const auto t = nearest_root(item.shape, seen_by(item, ray));
    if (t && (!found.t || compare(*t, *found.t) < 0)) found = {item.object, t};
  }
  return found;
}

int Oracle::object_at(int x, int y) const { return nearest(ray_at(x, y)).object; }

Oracle::Reach Oracle::reach(const Ray& ray, int object) const {
  const mpf_class metre = real(Integer(1) << static_cast<unsigned>(shift_)), w = real(ray.w);
  Reach result{0, mpf_class(0, kFloatBits), sqrt(real(dot(ray.direction, ray.direction))) / w / metre};
  const auto take = [&](const mpf_class& t) {
    for (int axis = 0; axis < 3; ++axis) {
      const mpf_class at = (real(ray.origin[axis]) + t * real(ray.direction[axis])) / w / metre;
      result.magnitude = std::max(result.magnitude, std::abs(at.get_d()));
    }
  };
  take(mpf_class(0));
  const int seen = nearest(ray).object;
  for (const Item& item : items_) {
    if (item.object != object && item.object != seen) continue;
    result.magnitude = std::max(result.magnitude, item.shape.reach);
    if (const auto hit = nearest_root(item.shape, seen_by(item, ray))) {
      result.t = std::max(result.t, real(*hit));
      take(real(*hit));
    }
  }
  if (result.t == 0) result.t = result.magnitude / result.speed;
  return result;
}

std::vector<Ray> Oracle::moved_rays(const Ray& ray, const mpf_class& t, double distance) const {
  constexpr unsigned kMore = 512;
  const int shift = shift_ + static_cast<int>(kMore);
  std::vector<IVec> steps{{0, 0, 0}};  // displacements across the ray, in units of 2^-shift
  for (int i = 0; i < 8; ++i) {
    const double angle = i * 0.78539816339744831;
    const Integer u = in_units(distance * std::cos(angle), shift + 1100) >> 1100,
                  v = in_units(distance * std::sin(angle), shift + 1100) >> 1100;
    const IVec sum = right_ * u + up_ * v;
    steps.push_back({sum.x / scale_, sum.y / scale_, sum.z / scale_});
  }
  const Integer per_t(mpf_class(real(ray.w) / t * real(kOne)));
  const Integer more = Integer(1) << kMore;
  std::vector<Ray> moved;
  for (const IVec& at_origin : steps)
    for (const IVec& at_hit : steps) {
      const IVec turned = (at_hit - at_origin) * per_t;
      moved.push_back({(ray.origin * more + at_origin * ray.w) * kOne, ray.w * more * kOne,
                       ray.direction * (more * kOne) + turned});
    }
  return moved;
}

bool Oracle::explains(int x, int y, int object, double roundings, double epsilon) const {
  const Ray ray = ray_at(x, y);
  const Reach in_play = reach(ray, object);
  const double distance = roundings * epsilon * in_play.magnitude;
  const std::vector<Ray> moved = moved_rays(ray, in_play.t, distance);
  const mpf_class slack = distance / in_play.speed;

  // Rounding moves the ray independently for each object. Tests whether such moves can make `object` the
  // nearest.
  std::optional<mpf_class> soonest;
  for (const Item& item : items_)
    if (item.object == object)
      for (const Ray& r : moved)
        if (const auto hit = nearest_root(item.shape, seen_by(item, r)))
          soonest = soonest ? std::min(*soonest, real(*hit)) : real(*hit);
  if (object != 0 && !soonest) return false;
  const auto yields = [&](const Item& item) {
    if (item.object == object) return true;
    return std::any_of(moved.begin(), moved.end(), [&](const Ray& r) {
      const auto hit = nearest_root(item.shape, seen_by(item, r));
      return !hit || (soonest && real(*hit) + slack >= *soonest - slack);
    });
  };
  return std::all_of(items_.begin(), items_.end(), yields);
}

}  // namespace orrery::exact
