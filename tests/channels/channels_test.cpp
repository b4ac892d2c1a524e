#include <gtest/gtest.h>

#include <cmath>

#include "core/channels/registry.h"
#include "tests/support/pictures.h"

// Tests film channels, which store properties of the first hits of camera rays.
namespace orrery::test {
namespace {

const ChannelType& channel(std::string_view name) {
  for (const ChannelType& type : channel_types())
    if (name == type.name) return type;
  throw std::invalid_argument(std::string(name));
}

struct Layers {
  Film film;
  int width;
  float at(std::size_t layer, std::size_t component, int x, int y) const {
    return film.values(layer, component)[static_cast<std::size_t>(y * width + x)];
  }
};

Layers render_layers(const Json& json, const RenderRequest& request, const std::vector<std::string>& names) {
  const PreparedScene scene(load(json));
  Plan plan = make_plan(scene.scene(), request);
  for (const std::string& name : names) {
    plan.channels.push_back(&channel(name));
    plan.fields |= channel(name).fields;
  }
  return {render_frame(scene, settle(scene, plan), FilmStorage::sums, shared_executor()).film, plan.width};
}

RenderRequest odd_size() { return in_double(size(33, 33)); }  // the centre of a pixel is on the optical axis

const char* const kBall = "[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}]";

TEST(Channels, StoresDistanceAlongRayAsDepth) {
  const Layers layers = render_layers(scene_of(kBall), odd_size(), {"depth"});
  EXPECT_EQ(layers.at(0, 0, 16, 16), 3.0f);
  EXPECT_EQ(layers.at(0, 0, 0, 0), std::numeric_limits<float>::infinity()) << "the ray misses";
}

TEST(Channels, StoresSurfaceNormalAndPosition) {
  const Layers layers = render_layers(scene_of(kBall), odd_size(), {"normal", "position"});
  for (int x = 12; x <= 20; ++x)
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(layers.at(0, c, x, 14), layers.at(1, c, x, 14), 1e-7) << "equal on the unit sphere";
  EXPECT_EQ(layers.at(0, 2, 16, 16), 1.0f);
  EXPECT_EQ(layers.at(0, 2, 0, 0), 0.0f);
}

// Shapes are stored by type, but object numbers follow the order of the file.
TEST(Channels, NumbersObjectsInFileOrder) {
  const Json scene = scene_of(R"([
      {'type': 'box', 'min': [-3, -1, -1], 'max': [-1.5, 1, 1]},
      {'type': 'sphere', 'center': [0, 0, 0], 'radius': 0.5},
      {'type': 'box', 'min': [1.5, -1, -1], 'max': [3, 1, 1]}])",
                              R"({'models': {'ball': {'objects':
      [{'type': 'sphere', 'center': [0, 0, 0], 'radius': 0.3, 'material': 'white'}]}},
      'instances': [{'model': 'ball', 'translate': [0, 1.1, 0]}, {'model': 'ball', 'translate': [0, -1.1, 0]}],
      'camera': {'type': 'orthographic', 'height': 4, 'eye': [0, 0, 4], 'look_at': [0, 0, 0]}})");
  const Layers layers = render_layers(scene, in_double(size(48, 41)), {"object"});
  const auto at = [&](double x, double y) {  // metres
    return layers.at(0, 0, static_cast<int>(23.5 + x / 4 * 41), static_cast<int>(20.5 - y / 4 * 41));
  };
  EXPECT_EQ(at(-2, 0), 1);
  EXPECT_EQ(at(0, 0), 2);
  EXPECT_EQ(at(2, 0), 3);
  EXPECT_EQ(at(0, 1.1), 4);
  EXPECT_EQ(at(0, -1.1), 5);
  EXPECT_EQ(at(-2, 1.8), 0);
}

TEST(Channels, InterpolatesMeshTextureCoordinates) {
  const Json scene =
      scene_of(R"([{'type': 'mesh',
      'positions': [[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]], 'indices': [[0, 1, 2], [0, 2, 3]],
      'uvs': [[0, 0], [1, 0], [1, 0.5], [0, 0.5]]}])",
               "{'camera': {'type': 'orthographic', 'height': 4, 'eye': [0, 0, 4], 'look_at': [0, 0, 0]}}");
  const Layers layers = render_layers(scene, in_double(size(64, 64)), {"uv"});
  for (const int x : {3, 20, 63})
    for (const int y : {0, 31, 50}) {
      EXPECT_NEAR(layers.at(0, 0, x, y), (x + 0.5) / 64, 1e-6);
      EXPECT_NEAR(layers.at(0, 1, x, y), 0.5 * (1 - (y + 0.5) / 64), 1e-6);
    }
}

TEST(Channels, StoresPixelWidthAtHitAsFootprint) {
  const char* const wall = "[{'type': 'plane', 'point': [0, 0, -6], 'normal': [0, 0, 1]}]";
  const Layers layers = render_layers(scene_of(wall), odd_size(), {"footprint"});
  EXPECT_NEAR(layers.at(0, 0, 16, 16), 10 * 2 * std::tan(std::numbers::pi / 8) / 33, 1e-6);
}

// The mean of a pixel counts only the samples that hit an object.
TEST(Channels, AveragesOnlyHitSamplesAtEdges) {
  RenderRequest request = odd_size();
  request.samples = 16;
  const Layers layers = render_layers(scene_of(kBall), request, {"depth", "object"});
  int edges = 0;
  for (int y = 0; y < 33; ++y)
    for (int x = 0; x < 33; ++x) {
      const float depth = layers.at(0, 0, x, y), object = layers.at(1, 0, x, y);
      if (std::isfinite(depth)) {
        EXPECT_GE(depth, 3);
        EXPECT_LE(depth, 4);
      }
      edges += std::isfinite(depth) && object == 0;
      EXPECT_TRUE(object == 0 || object == 1) << "object numbers are not averaged";
    }
  EXPECT_GT(edges, 0);
}

TEST(Channels, LeavesImageUnchanged) {
  const Json scene = sample("instances");
  const RenderRequest request = size(64, 48);
  std::vector<std::string> all;
  for (const ChannelType& type : channel_types()) all.push_back(type.name);
  const Image with = render_layers(scene, request, all).film.image(PixelFormat::linear32);
  const Picture without = render(scene, request);
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x) ASSERT_EQ(with.linear(x, y), without.at(x, y)) << x << ", " << y;
}

// Passes of 4, 1 and 4 samples add up to the film of a single render with 9 samples.
TEST(Film, AccumulatesPassesToFullRender) {
  const PreparedScene scene(load(sample("glass")));
  RenderRequest request = size(70, 45);
  request.samples = 9;
  Plan plan = make_plan(scene.scene(), request);
  plan.channels = {&channel("depth"), &channel("object")};
  plan.fields |= channel("object").fields;
  const SettledPlan settled = settle(scene, plan);
  const Film whole = render_frame(scene, settled, FilmStorage::sums, shared_executor()).film;

  RenderStats stats;
  const auto prepared = threads_backend(shared_executor())->prepare(scene, settled, stats, {});
  Film passes(plan.width, plan.height, FilmStorage::sums, plan.channels);
  const TileGrid grid(plan.width, plan.height);
  for (const auto& [first, samples] : {std::pair{0, 4}, {4, 1}, {5, 4}}) {
    std::vector<TileView> tiles;
    for (int i = 0; i < grid.size(); ++i) {
      tiles.push_back(grid.at(i, samples));
      tiles.back().first_sample = first;
    }
    prepared->render(tiles, passes, stats, {});
  }
  const Image a = whole.image(PixelFormat::linear32), b = passes.image(PixelFormat::linear32);
  EXPECT_TRUE(std::ranges::equal(a.bytes(), b.bytes()));
  EXPECT_EQ(whole.values(0, 0), passes.values(0, 0));
  EXPECT_EQ(whole.values(1, 0), passes.values(1, 0));
}

// A film stores `sums`, linear float or sRGB codes. An image converted from a more precise film equals the
// image in a film of the image's format.
TEST(Film, ReturnsSameImageFromEveryStorage) {
  const PreparedScene scene(load(sample("paper")));
  RenderRequest request = size(50, 40);
  request.samples = 3;
  const SettledPlan plan = settle(scene, make_plan(scene.scene(), request));
  const auto film = [&](FilmStorage storage) {
    return render_frame(scene, plan, storage, shared_executor()).film;
  };
  const Film codes = film(FilmStorage::srgb8), floats = film(FilmStorage::linear32),
             sums = film(FilmStorage::sums);
  const auto same = [](const Image& a, const Image& b) { return std::ranges::equal(a.bytes(), b.bytes()); };
  EXPECT_TRUE(same(floats.stored(), sums.image(PixelFormat::linear32)));
  EXPECT_TRUE(same(codes.stored(), floats.image(PixelFormat::srgb8)));
  EXPECT_TRUE(same(codes.stored(), sums.image(PixelFormat::srgb8)));
}

}  // namespace
}  // namespace orrery::test
