#include "server/import/environment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <optional>

#include "core/base/task_scope.h"
#include "core/image/decode/picture.h"
#include "core/image/encode/files.h"
#include "core/image/image.h"
#include "core/meshes/text.h"
#include "server/import/spectrum.h"

namespace orrery {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr int kMaxRows = 2048;  // rows of a written image

struct ImagePoint {
  double u, v;  // 0 to 1, from the upper left
};

// Point of a direction in an image of scenes: -z at the centre, +y at the top, +x in the right half.
Vec3d direction_at(double u, double v) {
  const double azimuth = (u - 0.5) * kTurn, polar = v * std::numbers::pi;
  return {std::sin(azimuth) * std::sin(polar), std::cos(polar), -std::cos(azimuth) * std::sin(polar)};
}

ImagePoint equirectangular(const Vec3d& d) {
  const double turns = std::atan2(d.x, -d.z) / kTurn + 0.5;
  return {turns - std::floor(turns), std::acos(std::clamp(d.y, -1.0, 1.0)) / std::numbers::pi};
}

// Clarberg, "Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD", Journal of Graphics Tools 13(3), 2008,
// with the axes of pbrt-v4: +z at the centre.
ImagePoint octahedral(const Vec3d& d) {
  const double radius = std::sqrt(std::max(0.0, 1 - std::abs(d.z)));
  double v = std::atan2(std::abs(d.y), std::abs(d.x)) * 2 / std::numbers::pi * radius, u = radius - v;
  if (d.z < 0) {
    std::swap(u, v);
    u = 1 - u;
    v = 1 - v;
  }
  return {(std::copysign(u, d.x) + 1) / 2, (std::copysign(v, d.y) + 1) / 2};
}

// Map from directions of an image of scenes to those of an equirectangular image of a description.
Affined layout_map(EnvironmentLayout layout) {
  if (layout == EnvironmentLayout::mitsuba) return {{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}, {}};
  return {{0, -1, 0}, {0, 0, 1}, {1, 0, 0}, {}};
}

// Returns the angle of a rotation about +y in degrees, or nullopt for other maps.
std::optional<double> turn_about_y(const Affined& map) {
  const auto scale = uniform_scale(map);
  if (!scale || scaled_determinant(map) < 0 || length(map.y / *scale - Vec3d(0, 1, 0)) > kMaxSkew)
    return std::nullopt;
  const double degrees = std::atan2(-map.x.z, map.x.x) * 360 / kTurn;
  return degrees == 0 ? 0 : degrees;
}

Texels read_image(SceneWriter& scene, const ReadNearby& nearby, const std::string& file) {
  try {
    return read_picture(nearby(file));
  } catch (const InputError& error) {
    scene.refuse("image " + excerpt(file, 80) + ": " + error.problems().front().detail);
  }
}

// Bilinear interpolation between the centres of texels. Equirectangular images repeat along u.
Vec3d texel_at(const Texels& image, const ImagePoint& point, bool repeats) {
  const double x = point.u * image.width - 0.5, y = point.v * image.height - 0.5;
  const double left = std::floor(x), top = std::floor(y);
  Vec3d sum(0.0);
  for (int i = 0; i < 4; ++i) {
    const int dx = i % 2, dy = i / 2;
    int column = static_cast<int>(left) + dx;
    column = repeats ? (column + image.width) % image.width : std::clamp(column, 0, image.width - 1);
    const int row = std::clamp(static_cast<int>(top) + dy, 0, image.height - 1);
    const float* rgb = &image.rgb[3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                                       static_cast<std::size_t>(column))];
    const double weight = (dx != 0 ? x - left : 1 - x + left) * (dy != 0 ? y - top : 1 - y + top);
    sum = sum + Vec3d(rgb[0], rgb[1], rgb[2]) * weight;
  }
  return sum;
}

// Returns an equirectangular image of scenes with radiance(direction), averaged over four points per pixel.
template <class Radiance>
Image equirectangular_image(int rows, const Radiance& radiance) {
  Image image(2 * rows, rows, PixelFormat::linear32);
  std::byte* out = image.bytes().data();
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < 2 * rows; ++x) {
      checkpoint(static_cast<std::size_t>(x));
      Vec3d sum(0.0);
      for (int i = 0; i < 4; ++i)
        sum = sum + radiance(direction_at((x + 0.25 + 0.5 * (i % 2)) / (2 * rows),
                                          (y + 0.25 + 0.5 * (i / 2)) / rows));
      const Vec3f pixel(sum / 4);
      std::memcpy(out, &pixel, sizeof pixel);
      out += sizeof pixel;
    }
  return image;
}

// Returns the mean of an equal-area image, or of an equirectangular one by the solid angles of its rows.
Vec3d mean_of(const Texels& image, bool is_equal_area) {
  Vec3d sum(0.0);
  double weights = 0;
  for (int y = 0; y < image.height; ++y) {
    const double weight = is_equal_area ? 1 : std::sin((y + 0.5) / image.height * std::numbers::pi);
    for (int x = 0; x < image.width; ++x) {
      checkpoint(static_cast<std::size_t>(x));
      const std::size_t at = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                  static_cast<std::size_t>(x));
      sum = sum + Vec3d(image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]) * weight;
    }
    weights += weight * image.width;
  }
  return sum / weights;
}

bool is_grey(const Vec3d& c) { return c.x == c.y && c.y == c.z; }

}  // namespace

void add_constant_environment(SceneWriter& scene, const Vec3d& radiance) {
  const SceneJson* const present = scene.find("environment");
  Vec3d sum = radiance;
  if (present != nullptr) {
    if (present->at("type") != "constant") {
      scene.notes().add("second light from all directions is left out");
      return;
    }
    const SceneJson& before = present->at("radiance");
    sum = sum + Vec3d(before[0].get<double>(), before[1].get<double>(), before[2].get<double>());
  }
  scene.set("environment", {{"type", "constant"}, {"radiance", scene.color(sum)}});
}

void add_image_environment(SceneWriter& scene, const ReadNearby& nearby, const std::string& file,
                           EnvironmentLayout layout, const Affined& map, const Vec3d& scale) {
  if (scene.find("environment") != nullptr) {
    scene.notes().add("second light from all directions is left out");
    return;
  }
  const std::string name = scene.file_name(file);
  const Affined whole = compose(map, layout_map(layout));
  const auto turn = turn_about_y(whole);
  const bool can_stay = turn && is_grey(scale);
  const auto keep_file = [&] {
    scene.set("environment",
              {{"type", "image"}, {"file", name}, {"rotation_degrees", *turn}, {"scale", scale.x}});
  };
  if (can_stay && layout == EnvironmentLayout::mitsuba) return keep_file();
  const Texels image = read_image(scene, nearby, file);
  const bool is_square = layout == EnvironmentLayout::pbrt && image.width == image.height;
  if (can_stay && !is_square) return keep_file();
  if (!scene.writes_files()) {
    scene.notes().add("image of the surroundings is replaced by its mean; --output keeps it");
    return add_constant_environment(scene, mean_of(image, is_square) * scale);
  }
  if (scaled_determinant(map) == 0) scene.refuse("transformation of a light must have an inverse");
  const Affined back =
      inverse(is_square ? Affined{map.x, map.y, map.z, {}} : Affined{whole.x, whole.y, whole.z, {}});
  const int rows = std::min(is_square ? image.height : std::max(image.height, 1), kMaxRows);
  const Image turned = equirectangular_image(rows, [&](const Vec3d& d) {
    const Vec3d light = safe_normalize(back.vector(d));
    return texel_at(image, is_square ? octahedral(light) : equirectangular(light), !is_square) * scale;
  });
  scene.set("environment", {{"type", "image"}, {"file", scene.add_file(".exr", encode_exr(turned))}});
}

}  // namespace orrery
