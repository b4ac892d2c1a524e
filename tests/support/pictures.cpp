#include "tests/support/pictures.h"

#include <cmath>
#include <cstring>
#include <limits>

#include "core/image/srgb.h"

namespace orrery::test {
namespace {

// Returns the largest difference of a channel, or infinity if a difference is NaN or infinite.
double distance(const Vec3f& a, const Vec3f& b) {
  const Vec3d d = abs(Vec3d(a) - Vec3d(b));
  return std::isfinite(d.x + d.y + d.z) ? max_component(d) : std::numeric_limits<double>::infinity();
}

RenderResult rendered_by(Executor& executor, const std::shared_ptr<const Scene>& scene,
                         const RenderRequest& request, const RenderControl& control) {
  const PreparedScene prepared(scene);
  return render_frame(prepared, settle(prepared, make_plan(*scene, request)), FilmStorage::linear32, executor,
                      control);
}

}  // namespace

double Picture::sum(float Vec3f::*channel) const {
  double total = 0;
  for (const Vec3f& pixel : pixels) total += static_cast<double>(pixel.*channel);
  return total;
}

int Picture::brighter_than(float level) const {
  int count = 0;
  for (const Vec3f& pixel : pixels) count += max_component(pixel) > level;
  return count;
}

Executor& shared_executor() {
  static ThreadExecutor executor(2);
  return executor;
}

Picture render(const Json& scene, const RenderRequest& request, int threads) {
  return render(load(scene), request, threads);
}

Picture render(const std::shared_ptr<const Scene>& scene, const RenderRequest& request, int threads) {
  std::unique_ptr<ThreadExecutor> own;
  if (threads > 0) own = std::make_unique<ThreadExecutor>(threads);
  const RenderResult result = rendered_by(own ? *own : shared_executor(), scene, request, {});
  Picture picture{result.film.width(), result.film.height(), {}, result.stats};
  picture.pixels.resize(static_cast<std::size_t>(picture.width * picture.height));
  const Image image = result.film.image(PixelFormat::linear32);
  std::memcpy(static_cast<void*>(picture.pixels.data()), image.bytes().data(), image.bytes().size());
  return picture;
}

RenderResult rendered(const std::shared_ptr<const Scene>& scene, const RenderRequest& request,
                      const RenderControl& control) {
  return rendered_by(shared_executor(), scene, request, control);
}

std::vector<double> linear_values(const Film& film) {
  const Image image = film.image(PixelFormat::linear32);
  return {image.values().begin(), image.values().end()};
}

std::vector<double> shown(std::vector<double> linear) {
  for (double& value : linear) value = encode_srgb(value);
  return linear;
}

double rms_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double squares = 0;
  for (std::size_t i = 0; i < a.size(); ++i) squares += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(squares / static_cast<double>(a.size()));
}

double largest_difference(const Picture& a, const Picture& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    largest = std::max(largest, distance(a.pixels[i], b.pixels[i]));
  return largest;
}

bool identical(const Picture& a, const Picture& b) {
  return a.pixels.size() == b.pixels.size() &&
         std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(Vec3f)) == 0;
}

int differing_pixels(const Picture& a, const Picture& b, double tolerance) {
  int count = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    count += !(distance(a.pixels[i], b.pixels[i]) <= tolerance);
  return count;
}

RenderRequest size(int width, int height) {
  RenderRequest request;
  request.width = width;
  request.height = height;
  return request;
}

RenderRequest in_double(RenderRequest request) {
  request.precision = Precision::double_precision;
  return request;
}

RenderRequest in_float(RenderRequest request) {
  request.precision = Precision::single_precision;
  return request;
}

}  // namespace orrery::test
