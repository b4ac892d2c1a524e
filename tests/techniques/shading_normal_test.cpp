#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/covers.h"
#include "tests/support/random.h"
#include "tests/support/tracing.h"

// Tests meshes with interpolated normals. Light must follow the geometric surface.
namespace orrery::test {
namespace {

// Returns a triangle in the plane z = 0 whose vertex normals are tilted outward by 60 degrees.
Json leaning(const Json& material) {
  Json mesh =
      json(R"({'type': 'mesh', 'positions': [[-1, -1, 0], [1, -1, 0], [0, 1, 0]], 'indices': [[0, 1, 2]],
                       'normals': [[-1.5, -0.9, 1], [1.5, -0.9, 1], [0, 1.7, 1]], 'material': 'it'})");
  return scene_with(mesh, Json{{"materials", {{"it", material}}}, {"background", {1, 1, 1}}});
}

// For slanted rays, the direction mirrored about a tilted normal would be below the surface. The geometric
// normal is used instead.
TEST(ShadingNormal, ReflectsNoRayIntoSurface) {
  covers("C12");
  Tracing tracing(leaning(json("{'type': 'reflective', 'n': [0, 0, 0], 'k': [0, 0, 0]}")));
  Random random(1);
  int sunk = 0, sent = 0;
  for (int i = 0; i < 5'000; ++i) {
    const Vec3d at(random.between(-0.4, 0.4), random.between(-0.8, 0), 0);
    Vec3d direction = random.direction_above(Vec3d(0, 0, 1)) * -1;
    direction.z *= random.magnitude(1e-3, 1);
    direction = safe_normalize(direction);
    const TraceOutput answer = tracing.trace(Ray<double>{at - direction * 2, direction});
    if (tracing.rays().size() < 2) continue;
    ++sent;
    sunk += !(tracing.rays()[1][0].direction.z > 0);
    EXPECT_EQ(answer.radiance.x, 1) << "perfect mirror under a uniform sky";
  }
  EXPECT_GT(sent, 4'000);
  EXPECT_EQ(sunk, 0);
}

// A mirror never creates light, for any tilt of its normals.
TEST(ShadingNormal, CreatesNoLight) {
  Tracing tracing(leaning(json("{'type': 'reflective', 'n': [0.14, 0.16, 0.13], 'k': [4.1, 2.3, 3.1]}")));
  Random random(2);
  for (int i = 0; i < 2'000; ++i) {
    const Vec3d direction = random.direction_above(Vec3d(0, 0, 1)) * -1;
    const Vec3d seen =
        tracing.trace(Ray<double>{Vec3d(random.between(-0.4, 0.4), -0.3, 0) - direction * 2, direction})
            .radiance;
    EXPECT_TRUE(seen.x >= 0 && seen.x <= 1 && seen.y <= 1 && seen.z <= 1) << seen.x;
  }
}

}  // namespace
}  // namespace orrery::test
