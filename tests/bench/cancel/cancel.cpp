#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "core/accelerators/registry.h"
#include "core/base/clock.h"
#include "core/base/task_scope.h"
#include "core/budget/renderer.h"
#include "core/meshes/repair.h"
#include "core/params/document.h"
#include "core/plan/plan.h"
#include "core/render/views.h"
#include "tests/bench/measuring.h"
#include "tests/meshes/writers.h"

// Measures the time from a stop request to the end of each stage.
//   cancel TIMES    stops each stage TIMES times, at moments spread over its duration
// Prints lines of JSON.
namespace orrery::bench {
namespace {

using Stage = std::function<void(const std::stop_token&)>;

// Returns a wavy sheet of 2 * side^2 triangles.
TriangleMesh sheet(std::uint32_t side) {
  TriangleMesh mesh;
  for (std::uint32_t y = 0; y <= side; ++y)
    for (std::uint32_t x = 0; x <= side; ++x)
      mesh.positions.push_back(
          {double(x) / side, 0.1 * std::sin(0.05 * x) * std::cos(0.07 * y), double(y) / side});
  for (std::uint32_t y = 0; y < side; ++y)
    for (std::uint32_t x = 0; x < side; ++x) {
      const std::uint32_t a = y * (side + 1) + x;
      mesh.triangles.push_back({a, a + 1, a + side + 2});
      mesh.triangles.push_back({a, a + side + 2, a + side + 1});
    }
  return mesh;
}

const char* kScene = R"({"version": 1,
  "camera": {"type": "perspective", "eye": [0.5, 1, 2], "look_at": [0.5, 0, 0.5]},
  "image": {"width": 2048, "height": 2048},
  "background": [0.2, 0.4, 0.8],
  "materials": {"m": {"type": "refractive", "ior": 1.5}},
  "lights": [{"type": "directional", "direction_to_light": [1, 1, 1], "intensity": [2, 2, 2]}],
  "objects": [{"type": "mesh", "file": "mesh", "material": "m"CREASE}]})";

std::string scene_text(const std::string& crease) {
  std::string text = kScene;
  return text.replace(text.find("CREASE"), 6, crease);
}

std::string numbers_text(std::size_t count) {
  std::string text = "[0";
  for (std::size_t i = 1; i < count; ++i) text += ",[[" + std::to_string(i) + ".5]]";
  return text + "]";
}

std::string polygon_text(std::size_t corners) {
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2";
  for (std::size_t i = 0; i < corners; ++i) text += i % 2 ? " 3" : " 2";
  return text + "\n";
}

std::string glb_of(const TriangleMesh& mesh) {
  std::string data, glb = "glTF";
  for (const Vec3d& p : mesh.positions)
    for (const double x : {p.x, p.y, p.z}) test::append(data, static_cast<float>(x));
  const std::size_t first_index = data.size(), indices = 3 * mesh.triangles.size();
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle) test::append(data, vertex);
  const auto view = [](std::size_t from, std::size_t bytes) {
    return nlohmann::json{{"buffer", 0}, {"byteOffset", from}, {"byteLength", bytes}};
  };
  const auto accessor = [](int buffer_view, int type, const char* shape, std::size_t count) {
    return nlohmann::json{
        {"bufferView", buffer_view}, {"componentType", type}, {"type", shape}, {"count", count}};
  };
  constexpr int kFloat = 5126, kUnsignedInt = 5125;
  const nlohmann::json primitive = {{"attributes", {{"POSITION", 0}}}, {"indices", 1}};
  const nlohmann::json json = {
      {"asset", {{"version", "2.0"}}},
      {"buffers", {{{"byteLength", data.size()}}}},
      {"bufferViews", {view(0, first_index), view(first_index, 4 * indices)}},
      {"accessors",
       {accessor(0, kFloat, "VEC3", mesh.positions.size()), accessor(1, kUnsignedInt, "SCALAR", indices)}},
      {"meshes", {{{"primitives", nlohmann::json::array({primitive})}}}},
      {"nodes", {{{"mesh", 0}}}}};
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const auto append_word = [&](std::size_t word) { test::append(glb, static_cast<std::uint32_t>(word)); };
  append_word(2);
  append_word(12 + 8 + text.size() + 8 + data.size());
  append_word(text.size());
  glb += "JSON" + text;
  append_word(data.size());
  return glb + std::string("BIN\0", 4) + data;
}

// Runs the stage and requests a stop after `ms` milliseconds. Returns the milliseconds from the request until
// the stage threw Cancelled, or nullopt if the stage ended before the request.
std::optional<double> stop_after(const Stage& stage, double ms) {
  std::stop_source source;
  const std::stop_token stop = source.get_token();
  Clock::time_point asked;
  std::jthread stopper([&] {
    std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(ms));
    asked = Clock::now();
    source.request_stop();
  });
  try {
    const TaskScope scope({nullptr, &stop});
    stage(stop);
  } catch (const Cancelled&) {
    const auto ended = Clock::now();
    stopper.join();
    return std::chrono::duration<double, std::milli>(ended - asked).count();
  }
  return std::nullopt;
}

void measure(const std::string& name, int times, const Stage& stage) {
  double whole_ms = 0;
  for (int i = 0; i < 2; ++i) {  // the first run is a warm-up
    const auto start = Clock::now();
    stage({});
    whole_ms = milliseconds_since(start);
  }
  std::vector<double> took;
  int done_before = 0;
  for (int i = 0; i < times; ++i) {
    const auto ms = stop_after(stage, whole_ms * (i + 0.5) / times);
    ms ? took.push_back(*ms) : void(++done_before);
  }
  std::sort(took.begin(), took.end());
  const nlohmann::ordered_json line = {{"stage", name},
                                       {"whole_ms", whole_ms},
                                       {"cancelled", took.size()},
                                       {"done_before", done_before},
                                       {"p50_ms", took.empty() ? 0 : took[took.size() / 2]},
                                       {"most_ms", took.empty() ? 0 : took.back()}};
  std::printf("%s\n", line.dump().c_str());
  std::fflush(stdout);
}

void measure_loading(int times) {
  const TriangleMesh mesh = sheet(700);
  const std::string numbers = numbers_text(330'000), polygon = polygon_text(4'000'000);
  measure("JSON", times, [&](const std::stop_token&) { parse_document(numbers); });
  measure("OBJ, a polygon", times, [&](const std::stop_token&) { read_mesh(polygon); });
  const std::pair<const char*, std::string> files[] = {{"OBJ", test::obj_of(mesh)},
                                                       {"PLY", test::ply_of(mesh, std::endian::little)},
                                                       {"STL", test::binary_stl_of(mesh)},
                                                       {"glTF", glb_of(mesh)}};
  for (const auto& [name, bytes] : files)
    measure(name, times, [&](const std::stop_token&) { read_mesh(bytes); });
  const OneModel source(model_of(mesh));
  measure("scene", times, [&](const std::stop_token&) { load_scene(scene_text(""), source); });
  measure("smoothing", times,
          [&](const std::stop_token&) { load_scene(scene_text(R"(, "crease_degrees": 30)"), source); });
}

void measure_structures(int times) {
  const OneModel source(model_of(sheet(500)));
  const auto scene = load_scene(scene_text(""), source);
  for (const AcceleratorType& type : accelerator_types())
    measure(std::string("structure ") + type.name, times, [&](const std::stop_token& stop) {
      double build_ms = 0;
      world_for<float>(PreparedScene(scene).parts(), type, 0, build_ms, stop);
    });
  measure("settling", times,
          [&](const std::stop_token& stop) { settle(PreparedScene(scene), make_plan(*scene, {}), stop); });
}

void measure_rendering(int times) {
  const OneModel source(model_of(sheet(30)));
  const PreparedScene scene(load_scene(scene_text(""), source));
  ThreadExecutor executor;
  const SettledPlan plan = settle(scene, make_plan(scene.scene(), {}));
  measure("tracing", times, [&](const std::stop_token& stop) {
    render_frame(scene, plan, FilmStorage::linear32, executor, {.stop = stop});
  });
  const Film film = std::move(render_frame(scene, plan, FilmStorage::linear32, executor).film);
  for (const auto& [name, format] :
       {std::pair{"PNG", FileFormat::png}, {"JPEG", FileFormat::jpeg}, {"EXR", FileFormat::exr}})
    measure(name, times, [&, f = format](const std::stop_token&) { encode_film(film, f); });
}

}  // namespace
}  // namespace orrery::bench

int main(int count, char** words) {
  if (count != 2) return 2;
  const int times = std::atoi(words[1]);
  orrery::bench::measure_loading(times);
  orrery::bench::measure_structures(times);
  orrery::bench::measure_rendering(times);
}
