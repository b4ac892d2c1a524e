#include "tests/support/mixtures.h"

#include <cmath>

namespace orrery::test {

Json balls(int count, std::uint64_t seed) {
  Random random(seed);
  Json objects = Json::array();
  for (int i = 0; i < count; ++i)
    objects.push_back(
        {{"type", "sphere"}, {"center", numbers(random.in_cube(3))}, {"radius", random.between(0.05, 0.5)}});
  return scene_with(objects);
}

Json mixture(std::uint64_t seed) {
  Random random(seed);
  Json objects = Json::array();
  for (int i = 0; i < 4; ++i)
    for (const std::string& type : shape_names())
      for (const Json& object : shape_samples(type))
        objects.push_back(placed(object, random.magnitude(0.05, 0.6), random.in_cube(2)));
  return scene_with(objects);
}

Json wavy_sheet(int side) {
  Json positions = Json::array(), indices = Json::array();
  for (int row = 0; row <= side; ++row)
    for (int column = 0; column <= side; ++column) {
      const double x = 4.0 * column / side - 2, y = 4.0 * row / side - 2;
      positions.push_back({x, y, 0.5 * std::sin(4 * x) * std::cos(3 * y)});
    }
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      const int a = row * (side + 1) + column, b = a + 1, c = a + side + 1, d = c + 1;
      indices.push_back({a, b, c});
      indices.push_back({b, d, c});
    }
  return scene_with({{{"type", "mesh"}, {"positions", positions}, {"indices", indices}}});
}

Json planes(int count, std::uint64_t seed) {
  Random random(seed);
  Json objects = Json::array();
  for (int i = 0; i < count; ++i)
    objects.push_back(
        {{"type", "plane"}, {"point", numbers(random.in_cube(2))}, {"normal", numbers(random.direction())}});
  for (int i = 0; i < 3; ++i)
    objects.push_back({{"type", "sphere"}, {"center", numbers(random.in_cube(2))}, {"radius", 0.7}});
  return scene_with(objects);
}

}  // namespace orrery::test
