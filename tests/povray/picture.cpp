#include "tests/povray/picture.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "core/image/encode/files.h"
#include "core/model/technique.h"
#include "core/prepare/prepared_scene.h"

namespace orrery {

Picture render_picture(const PreparedScene& scene, const Plan& plan) {
  ThreadExecutor executor(1);
  const RenderResult result = render_frame(scene, settle(scene, plan), FilmStorage::linear32, executor);
  Picture picture(plan.width, plan.height);
  for (int y = 0; y < plan.height; ++y)
    for (int x = 0; x < plan.width; ++x) picture.at(x, y) = result.film.stored().linear(x, y);
  return picture;
}

namespace {

World<double> world_of(const PreparedScene& scene, const Plan& plan) {
  double build_ms = 0;
  return world_for<double>(scene.parts(), *plan.accelerator, plan.time, build_ms);
}

// Calls visit(rays, put) for each tile, with rays offset by (dx, dy) pixels from the pixel centres.
// put(pixels, slot, value) sets the pixel of element `slot` of the tile.
template <class Visit>
void for_each_tile(const Plan& plan, float dx, float dy, const Visit& visit) {
  TileSamples samples;
  samples.u.values.fill(0.5f + dx);
  samples.v.values.fill(0.5f + dy);
  const auto rays = std::make_unique<RayBatch<double>>();
  const TileGrid grid(plan.width, plan.height);
  for (int number = 0; number < grid.size(); ++number) {
    const TileView tile = grid.at(number, 1);
    plan.camera->generate(plan.frame, plan.width, plan.height, tile, samples, *rays);
    visit(*rays, [&](auto& pixels, int slot, const auto& value) {
      const int x = tile.x0 + tile_pixel(slot).x, y = tile.y0 + tile_pixel(slot).y;
      if (x < plan.width && y < plan.height) pixels[static_cast<std::size_t>(y * plan.width + x)] = value;
    });
  }
}

}  // namespace

Samples render_shifted(const PreparedScene& scene, const Plan& of_picture, float dx, float dy) {
  Plan plan = of_picture;
  plan.cut_range = plan.cut_range_beyond = Vec3d(1);  // the tracer then counts the weights of omitted rays
  const TracerPtr<double> tracer = make_tracer(*plan.technique, world_of(scene, plan), plan);
  const auto result = std::make_unique<TraceResult<double>>();
  TraceCounts counts;
  Samples samples{Picture(plan.width, plan.height), {}};
  samples.cut.resize(samples.picture.pixels.size());
  for_each_tile(plan, dx, dy, [&](const RayBatch<double>& rays, const auto& put) {
    tracer->trace(rays, Draws(plan.seed, TileView{0, 0, kTileSide, kTileSide}, 0), *result, counts);
    const Vec3Array<double>& radiance = result->radiance;
    for (int slot = 0; slot < kBatch; ++slot) {
      put(samples.picture.pixels, slot, Vec3f(Vec3d(radiance.x[slot], radiance.y[slot], radiance.z[slot])));
      put(samples.cut, slot, max_component(result->omitted[slot]) > 0);
    }
  });
  return samples;
}

std::vector<bool> normals_facing_away(const PreparedScene& scene, const Plan& plan) {
  const World<double> world = world_of(scene, plan);
  const LaneGroups all = LaneGroups::covering(0, kBatch, kWidth<double>);
  const auto hits = std::make_unique<HitBatch<double>>();
  const auto surface = std::make_unique<SurfaceBatch<double>>();
  AcceleratorCounts counts;
  std::vector<bool> away(static_cast<std::size_t>(plan.width) * static_cast<std::size_t>(plan.height));
  for_each_tile(plan, 0, 0, [&](const RayBatch<double>& rays, const auto& put) {
    hits->t = rays.t_max;
    hits->primitive.values.fill(kNoPrimitive);
    world.accelerator->closest(rays, all, *hits, counts);
    for (const auto& shapes : world.geometry->shapes) shapes->surface(rays, *hits, all, *surface);
    for (int i = 0; i < kBatch; ++i) {
      const Vec3d direction(rays.direction.x[i], rays.direction.y[i], rays.direction.z[i]);
      const Vec3d normal(surface->normal.x[i], surface->normal.y[i], surface->normal.z[i]);
      put(away, i, hits->primitive[i] != kNoPrimitive && dot(direction, normal) > 0);
    }
  });
  return away;
}

namespace {

Vec3f difference_by_channel(const Vec3f& a, const Vec3f& b, float brightest) {
  const auto one = [&](float x, float y) { return std::min(x, brightest) - std::min(y, brightest); };
  return abs(Vec3f(one(a.x, b.x), one(a.y, b.y), one(a.z, b.z)));
}

}  // namespace

float difference(const Vec3f& a, const Vec3f& b, float brightest) {
  return max_component(difference_by_channel(a, b, brightest));
}

Comparison compare(const Picture& a, const Picture& b, const std::vector<bool>& left_out, float brightest) {
  Comparison result;
  double inside = 0, all = 0;
  std::size_t left_out_count = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      const Vec3d d(difference_by_channel(a.at(x, y), b.at(x, y), brightest));
      all += dot(d, d);
      if (left_out[static_cast<std::size_t>(y * a.width + x)]) {
        ++left_out_count;
        continue;
      }
      inside += dot(d, d);
      if (max_component(d) > result.largest) {
        result.largest = max_component(d);
        result.largest_x = x;
        result.largest_y = y;
      }
    }
  const auto count = static_cast<double>(a.pixels.size()), without = static_cast<double>(left_out_count);
  result.rms = std::sqrt(inside / (3 * (count - without)));
  result.rms_of_all = std::sqrt(all / (3 * count));
  result.left_out = without / count;
  return result;
}

Picture difference_picture(const Picture& a, const Picture& b, const std::vector<bool>& left_out,
                           float brightest, float gain) {
  Picture out(a.width, a.height);
  for (std::size_t i = 0; i < out.pixels.size(); ++i)
    out.pixels[i] =
        left_out[i] ? Vec3f(0, 0, 0.3f) : difference_by_channel(a.pixels[i], b.pixels[i], brightest) * gain;
  return out;
}

void write_png(const Picture& picture, const std::string& path) {
  Image image(picture.width, picture.height, PixelFormat::srgb8);
  constexpr int kRun = 16;
  struct alignas(64) Run {
    float values[kRun] = {};
  } red, green, blue;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; x += kRun) {
      const int count = std::min(kRun, picture.width - x);
      for (int i = 0; i < count; ++i) {
        const Vec3f& pixel = picture.at(x + i, y);
        red.values[i] = pixel.x;
        green.values[i] = pixel.y;
        blue.values[i] = pixel.z;
      }
      image.set_row(x, y, count, red.values, green.values, blue.values);
    }
  std::ofstream(path, std::ios::binary) << encode_png(image);
}

}  // namespace orrery
