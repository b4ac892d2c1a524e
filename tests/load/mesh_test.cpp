#include <gtest/gtest.h>

#include "core/load/load.h"
#include "core/params/document.h"
#include "tests/support/scenes.h"

// Tests meshes that scenes reference by name.
namespace orrery::test {
namespace {

// Returns a roof of two rectangles that meet at 90 degrees, and a triangle without area.
TriangleMesh roof() {
  TriangleMesh mesh;
  mesh.positions = {{0, 1, 0}, {0, 1, 2}, {1, 0, 0}, {1, 0, 2}, {-1, 0, 0}, {-1, 0, 2}};
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {0, 4, 5}, {0, 5, 1}, {0, 0, 1}};
  return mesh;
}

class Shelf final : public AssetSource {
 public:
  MeshModelPtr model_file(const std::string& name, const ModelState&) const override {
    if (name != "roof.obj") throw InputError("", "cannot read " + name);
    return model_of(roof());
  }
  MeshModelPtr model_asset(const std::string& sha256, const ModelState&) const override {
    if (sha256 == "far") {
      TriangleMesh mesh = roof();
      mesh.positions[3].x = 1e13;
      return model_of(mesh);
    }
    return AssetSource::model_asset(sha256);
  }
};

std::string text_of(const char* object) { return scene_of(object).dump(); }

Problem problem_of(const char* object, const AssetSource& meshes) {
  try {
    load_scene(text_of(object), meshes);
  } catch (const InputError& error) {
    return error.problems().front();
  }
  return {"accepted", ""};
}

Vec3d shading_normal(const Scene& scene, const Vec3d& from, const Vec3d& toward) {
  for (const auto& shapes : scene.shapes) {
    if (shapes->size() == 0) continue;
    const auto kernel = shapes->kernel(double(), 0);
    RayBatch<double> rays{};
    HitBatch<double> hits{};
    SurfaceBatch<double> surface{};
    AcceleratorCounts counts;
    rays.count = 1;
    rays.t_max.values.fill(-1);
    rays.direction.z.values.fill(1);
    rays.origin.x[0] = from.x, rays.origin.y[0] = from.y, rays.origin.z[0] = from.z;
    rays.direction.x[0] = toward.x, rays.direction.y[0] = toward.y, rays.direction.z[0] = toward.z;
    rays.t_max[0] = 100;
    hits.t = rays.t_max;
    hits.primitive.values.fill(kNoPrimitive);
    for (int i = 0; i < shapes->size(); ++i) kernel->closest(i, rays, LaneGroups::single(0), hits, counts);
    kernel->surface(rays, hits, LaneGroups::single(0), surface);
    return {surface.normal.x[0], surface.normal.y[0], surface.normal.z[0]};
  }
  return {};
}

TEST(AssetFiles, LoadsFromAssetSource) {
  const auto scene = load_scene(text_of("[{'type': 'mesh', 'file': 'roof.obj'}]"), Shelf());
  EXPECT_EQ(scene->primitive_count(), 4);
  EXPECT_EQ(scene->facts.left_out, 1u);
}

TEST(AssetFiles, ReportsErrorsAtFileReference) {
  const Problem missing = problem_of("[{'type': 'mesh', 'file': 'wall.obj'}]", Shelf());
  EXPECT_EQ(missing.pointer, "/objects/0/file");
  EXPECT_EQ(missing.detail, "cannot read wall.obj");
  EXPECT_EQ(problem_of("[{'type': 'mesh', 'file': 'roof.obj'}]", AssetSource()).pointer, "/objects/0/file");
  EXPECT_EQ(problem_of("[{'type': 'mesh', 'asset': 'abc'}]", Shelf()).pointer, "/objects/0/asset");
  EXPECT_EQ(problem_of("[{'type': 'mesh', 'asset': 'far'}]", Shelf()).pointer, "/objects/0/asset");
  EXPECT_NE(problem_of("[{'type': 'mesh', 'file': 'roof.obj', 'asset': 'abc'}]", Shelf()).pointer,
            "accepted");
  EXPECT_EQ(problem_of("[{'type': 'mesh', 'file': 'roof.obj', 'crease_degrees': 181}]", Shelf()).pointer,
            "/objects/0/crease_degrees");
}

// Next to the ridge, the shading normal is the face normal for crease angles below 90 degrees, and vertical
// above.
TEST(AssetFiles, SmoothsEdgesBelowCreaseAngle) {
  const auto normal = [](const char* object) {
    return shading_normal(*load_scene(text_of(object), Shelf()), {1e-9, 3, 1}, {0, -1, 0});
  };
  const double slope = std::sqrt(0.5);
  for (const char* sharp : {"[{'type': 'mesh', 'file': 'roof.obj'}]",
                            "[{'type': 'mesh', 'file': 'roof.obj', 'crease_degrees': 80}]"}) {
    EXPECT_NEAR(normal(sharp).x, slope, 1e-6) << sharp;
    EXPECT_NEAR(normal(sharp).y, slope, 1e-6) << sharp;
  }
  const Vec3d smooth = normal("[{'type': 'mesh', 'file': 'roof.obj', 'crease_degrees': 100}]");
  EXPECT_NEAR(smooth.y, 1, 0.06);
  EXPECT_LT(std::abs(smooth.x), 0.35);
}

// Each state of a model is read once, also as a keyframe.
TEST(AssetFiles, AsksForStates) {
  class States final : public AssetSource {
   public:
    MeshModelPtr model_file(const std::string&, const ModelState& state) const override {
      asked.push_back(state);
      return model_of(roof());
    }
    mutable std::vector<ModelState> asked;
  };
  const States shelf;
  load_scene(text_of("[{'type': 'mesh', 'file': 'a', 'motion': [{'time': 0}, {'time': 1, 'file': 'a', "
                     "'pose_time': 2}]}, {'type': 'mesh', 'file': 'a', 'pose_time': -1.5, 'animation': 3},"
                     " {'type': 'mesh', 'file': 'a', 'pose_time': 2}, {'type': 'mesh', 'file': 'a', "
                     "'variant': 'red'}, {'type': 'mesh', 'file': 'a', 'variant': 'red'}]"),
             shelf);
  EXPECT_EQ(shelf.asked,
            (std::vector<ModelState>{
                {}, {.pose = ModelPose{0, 2}}, {.pose = ModelPose{3, -1.5}}, {.variant = "red"}}));
  const Problem alone = problem_of("[{'type': 'mesh', 'file': 'roof.obj', 'animation': 1}]", Shelf());
  EXPECT_EQ(alone.pointer, "/objects/0/animation");
  EXPECT_EQ(alone.detail, "must not be given without pose_time");
}

// A file that many objects refer to is read once.
TEST(AssetFiles, ReadsEachFileOncePerLoad) {
  class Counting final : public AssetSource {
   public:
    MeshModelPtr model_file(const std::string&, const ModelState&) const override {
      ++reads;
      return model_of(roof());
    }
    mutable int reads = 0;
  };
  Json objects = Json::array();
  for (int i = 0; i < 50; ++i) objects.push_back({{"type", "mesh"}, {"file", "roof.obj"}});
  const Counting shelf;
  EXPECT_EQ(load_scene(scene_with(objects).dump(), shelf)->primitive_count(), 200);
  EXPECT_EQ(shelf.reads, 1);
}

TEST(AssetFiles, RejectsTotalVerticesAboveLimit) {
  class Dots final : public AssetSource {
   public:
    MeshModelPtr model_file(const std::string&, const ModelState&) const override {
      TriangleMesh mesh = roof();
      mesh.positions.resize(4'000'000);
      return model_of(mesh);
    }
  };
  const char* const three =
      "[{'type': 'mesh', 'file': 'a'}, {'type': 'mesh', 'file': 'a'}, {'type': 'mesh', 'file': 'a'}]";
  const Problem problem = problem_of(three, Dots());
  EXPECT_EQ(problem.pointer, "/objects/2");
  EXPECT_NE(problem.detail.find("vertices (limit 10,000,000, mesh_vertices)"), std::string::npos)
      << problem.detail;
  EXPECT_EQ(problem_of("[{'type': 'mesh', 'file': ''}]", Shelf()).pointer, "/objects/0/file");
  Json models = scene_of("[]");
  for (const char* name : {"a", "b", "c"})
    models["models"][name]["objects"] = {{{"type", "mesh"}, {"file", "a"}, {"material", "white"}}};
  try {
    load_scene(models.dump(), Dots());
    FAIL() << "the limit applies to the sum over all models";
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().front().pointer, "/models/c/objects/0");
  }
}

// Several meshes share one shape set, but each keeps its own vertices and normals.
TEST(AssetFiles, KeepsMeshesSeparateInOneScene) {
  const auto scene = load_scene(
      text_of("[{'type': 'mesh', 'positions': [[5, 0, 0], [6, 0, 0], [5, 1, 0]], 'indices': [[0, 1, 2]],"
              "  'normals': [[1, 0, 1], [1, 0, 1], [1, 0, 1]]},"
              " {'type': 'mesh', 'file': 'roof.obj'},"
              " {'type': 'mesh', 'positions': [[8, 0, 0], [9, 0, 0], [8, 1, 0]], 'indices': [[0, 1, 2]],"
              "  'normals': [[-1, 0, 1], [-1, 0, 1], [-1, 0, 1]]}]"),
      Shelf());
  EXPECT_EQ(scene->primitive_count(), 6);
  EXPECT_NEAR(shading_normal(*scene, {5.2, 0.2, 3}, {0, 0, -1}).x, std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(shading_normal(*scene, {8.2, 0.2, 3}, {0, 0, -1}).x, -std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(shading_normal(*scene, {0.5, 3, 1}, {0, -1, 0}).x, std::sqrt(0.5), 1e-12);
}

// Smoothing around a vertex of n triangles compares n * n pairs of triangles.
TEST(AssetFiles, RejectsSmoothingAboveTriangleLimitPerVertex) {
  Json mesh = {{"type", "mesh"}, {"positions", {{0, 0, 1}}}, {"crease_degrees", 30}};
  const auto fan = [&](int triangles) {
    mesh["indices"] = Json::array();
    for (int i = static_cast<int>(mesh["positions"].size()) - 1; i <= triangles; ++i)
      mesh["positions"].push_back({std::cos(1e-4 * i), std::sin(1e-4 * i), 0});
    for (int i = 1; i <= triangles; ++i) mesh["indices"].push_back({0, i, i + 1});
    return scene_with(mesh);
  };
  EXPECT_EQ(first_problem(fan(33'000)), "/objects/0/crease_degrees");
  mesh["motion"] = {{{"time", 0}}, {{"time", 1}}};
  EXPECT_EQ(first_problem(fan(9'000)), "/objects/0/crease_degrees")
      << "each frame smooths moving meshes again";
}

}  // namespace
}  // namespace orrery::test
